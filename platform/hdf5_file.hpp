#pragma once
// The part of HDF5's C interface that records and problem files need, without its header. Every
// failure is an Error that begins with the file and names the dataset; HDF5 itself prints nothing.
//
// H5Cpp is not used: it wraps neither a driver of our own nor the switch that leaves times of day
// out, so half of the writer would be C all the same, and its header costs 0.3 s in each includer.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace ballast {

/// Owns one HDF5 handle (hid_t) and closes it.
class Hdf5Id {
 public:
  using Close = int (*)(std::int64_t);
  Hdf5Id(std::int64_t id, Close closer) : id_(id), close_(closer) {}
  ~Hdf5Id() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Id(Hdf5Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  operator std::int64_t() const { return id_; }
  /// Closes the handle at once; returns a negative number when that fails.
  int close() { return close_(std::exchange(id_, -1)); }

 private:
  std::int64_t id_;
  Close close_;
};

/// Sizes along the dimensions (hsize_t).
using Hdf5Shape = std::vector<unsigned long long>;

/// Base of Hdf5Reader and Hdf5Writer: keeps the name for errors, and silences HDF5 itself.
class Hdf5File {
 public:
  /// Throws Error "<file>: <what>".
  [[noreturn]] void fail(const std::string& what) const;

 protected:
  explicit Hdf5File(const std::filesystem::path& path);
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;
  /// Returns `result`. Where it is negative, throws Error "<file>: HDF5 cannot <action>".
  std::int64_t check(std::int64_t result, const std::string& action) const;

  const std::filesystem::path path_;
};

/// Reads an HDF5 file of any origin. Numbers are converted from any stored type.
class Hdf5Reader : public Hdf5File {
 public:
  explicit Hdf5Reader(const std::filesystem::path& file);

  bool has(const std::string& name) const;
  Hdf5Shape shape(const std::string& name) const;
  /// All entries of a dataset of numbers; Value is double, int or std::uint64_t. A dataset with
  /// another number of entries than `expected` is refused before memory is allocated.
  template <typename Value>
  std::vector<Value> read(const std::string& name,
                          std::optional<std::size_t> expected = std::nullopt) const;
  /// The only entry of a dataset.
  int read_int(const std::string& name) const;
  /// A text as Hdf5Writer::add_text stores it.
  std::string read_text(const std::string& name) const;
  /// `count` rows from row `first` on. A row has one index along the first dimension.
  std::vector<double> read_rows(const std::string& name, size_t first, size_t count = 1) const;
  std::vector<std::string> read_texts(const std::string& name) const;

 private:
  Hdf5Id open(const std::string& name) const;
  void require_stored(const std::string& name, const Hdf5Id& dataset,
                      unsigned long long entries) const;

  Hdf5Id file_;
};

/// How larger datasets are stored: as they are, or compressed and with a checksum.
enum class Hdf5Storage { plain, compressed };

/// How numbers are stored.
enum class Hdf5Number { float64, int32, int64, uint64 };

struct Hdf5Disk;

/// Writes an HDF5 file beside its target, which is replaced by commit(). The format is HDF5 1.8's,
/// with checksums of metadata, and without times of day: equal contents are equal bytes.
class Hdf5Writer : public Hdf5File {
 public:
  Hdf5Writer(const std::filesystem::path& target, Hdf5Storage storage);

  void add_group(const std::string& name);
  /// Attribute of a group or dataset; "/" is the file.
  void add_attribute(const std::string& object, const std::string& attribute,
                     const std::string& text);

  /// `numbers`: std::vector, std::span or Eigen::VectorXd of any type that Hdf5Number knows.
  template <typename Numbers>
  void add(const std::string& name, const Numbers& numbers, const Hdf5Shape& shape) {
    add(name, number_of(numbers.data()), numbers.data(), shape);
  }
  /// A dataset of one dimension.
  template <typename Numbers>
  void add(const std::string& name, const Numbers& numbers) {
    add(name, numbers, {static_cast<std::size_t>(numbers.size())});
  }
  void add(const std::string& name, const std::vector<std::string>& texts);
  /// One text, stored with its length.
  void add_text(const std::string& name, const std::string& text);

  /// Makes a dataset that write_rows() fills step by step with numbers that are given as doubles. A
  /// row has one index along the first dimension.
  Hdf5Id add_rows(const std::string& name, const Hdf5Shape& shape,
                  Hdf5Number number = Hdf5Number::float64);
  /// Writes whole rows, from row `first` on.
  void write_rows(const Hdf5Id& dataset, size_t first, std::span<const double> values);

  /// Makes the file safe on disk and renames it over the target. All datasets handed out must be
  /// closed by then; nothing can be added afterwards.
  void commit();

 private:
  static Hdf5Number number_of(const double*) { return Hdf5Number::float64; }
  static Hdf5Number number_of(const std::int32_t*) { return Hdf5Number::int32; }
  static Hdf5Number number_of(const std::int64_t*) { return Hdf5Number::int64; }
  static Hdf5Number number_of(const std::uint64_t*) { return Hdf5Number::uint64; }
  /// As Hdf5File::check(), but a failure of the disk takes precedence over one of HDF5.
  std::int64_t check(std::int64_t result, const std::string& action) const;
  Hdf5Id make_dataset(const std::string& name, std::int64_t type, const Hdf5Shape& shape,
                      Hdf5Storage storage);
  void add(const std::string& name, Hdf5Number number, const void* values, const Hdf5Shape& shape);

  Hdf5Storage storage_;
  std::shared_ptr<Hdf5Disk> disk_;
  Hdf5Id file_;
};

}  // namespace ballast
