#include "tests/fuzz/described_hdf5.hpp"

#include <hdf5.h>

#include <charconv>
#include <string>
#include <vector>

namespace ballast::fuzz {
namespace {

constexpr hsize_t most_written = 4096;  // entries

/// Removes the next word from the front of the text and returns it; empty at the end.
std::string_view next_word(std::string_view& text, std::string_view separators) {
  text.remove_prefix(std::min(text.find_first_not_of(separators), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(separators));
  text.remove_prefix(word.size());
  return word;
}

template <typename Number>
Number number_of(std::string_view word) {
  Number value{};
  std::from_chars(word.data(), word.data() + word.size(), value);
  return value;
}

hid_t type_of(std::string_view name) {
  struct Named {
    std::string_view name;
    hid_t type;
  };
  const Named types[] = {{"i1", H5T_STD_I8LE},    {"i2", H5T_STD_I16LE},  {"i4", H5T_STD_I32LE},
                         {"i8", H5T_STD_I64LE},   {"u4", H5T_STD_U32LE},  {"u8", H5T_STD_U64LE},
                         {"f4", H5T_IEEE_F32LE},  {"f8", H5T_IEEE_F64LE}, {"bi2", H5T_STD_I16BE},
                         {"bi4", H5T_STD_I32BE},  {"bi8", H5T_STD_I64BE}, {"bu8", H5T_STD_U64BE},
                         {"bf4", H5T_IEEE_F32BE}, {"bf8", H5T_IEEE_F64BE}};
  for (const Named& known : types)
    if (known.name == name) return known.type;
  return -1;
}

/// The dataspace of the shape "2,3"; "-" is a scalar.
hid_t space_of(std::string_view text) {
  if (text == "-") return H5Screate(H5S_SCALAR);
  std::vector<hsize_t> shape;
  for (auto word = next_word(text, ","); !word.empty(); word = next_word(text, ","))
    shape.push_back(number_of<hsize_t>(word));
  if (shape.empty() || shape.size() > 4) return -1;
  return H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
}

constexpr std::size_t letters_width = 8;

/// Writes the words as values of `type`: numbers, texts of any length, or texts of eight letters.
void write_values(hid_t dataset, hid_t type, std::string_view type_name, std::string_view words,
                  std::size_t count) {
  std::vector<std::string> texts(count);
  for (std::string& text : texts) text = next_word(words, " ");
  const void* values = nullptr;
  std::vector<const char*> pointers;
  std::vector<double> numbers;
  std::string letters;
  for (std::string& text : texts) {
    numbers.push_back(number_of<double>(text));
    pointers.push_back(text.c_str());
    letters += text.substr(0, letters_width);
    letters.resize((&text - texts.data() + 1) * letters_width);
  }
  if (type_name == "text")
    values = pointers.data();
  else if (type_name == "letters")
    values = letters.data();
  else
    values = numbers.data();
  const hid_t memory = values == numbers.data() ? H5T_NATIVE_DOUBLE : type;
  H5Dwrite(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
}

void add_dataset(hid_t file, hid_t links, const std::string& path, std::string_view line) {
  const std::string_view type_name = next_word(line, " ");
  const hid_t space = space_of(next_word(line, " "));
  const bool is_text = type_name == "text", is_letters = type_name == "letters";
  const hid_t type = is_text || is_letters ? H5Tcopy(H5T_C_S1) : type_of(type_name);
  if (is_text || is_letters) H5Tset_size(type, is_text ? H5T_VARIABLE : letters_width);
  const hid_t dataset = type < 0 || space < 0 ? -1
                                              : H5Dcreate2(file, path.c_str(), type, space, links,
                                                           H5P_DEFAULT, H5P_DEFAULT);
  const hssize_t count = space < 0 ? 0 : H5Sget_simple_extent_npoints(space);
  if (dataset >= 0 && count > 0 && static_cast<hsize_t>(count) <= most_written)
    write_values(dataset, type, type_name, line, static_cast<std::size_t>(count));
  if (dataset >= 0) H5Dclose(dataset);
  if (space >= 0) H5Sclose(space);
  if (is_text || is_letters) H5Tclose(type);
}

}  // namespace

void write_described_hdf5(std::string_view description, const std::filesystem::path& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  // Lets HDF5 keep freed memory. Under AddressSanitizer each file would map its megabytes anew.
  constexpr int kept = 1 << 26;  // bytes
  H5set_free_list_limits(kept, kept, kept, kept, kept, kept);
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t links = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  while (!description.empty()) {
    std::string_view line = description.substr(0, description.find('\n'));
    description.remove_prefix(std::min(line.size() + 1, description.size()));
    const std::string name(next_word(line, " "));
    if (name.empty() || name == "/") continue;
    if (line == " group") {
      const hid_t group = H5Gcreate2(file, name.c_str(), links, H5P_DEFAULT, H5P_DEFAULT);
      if (group >= 0) H5Gclose(group);
    } else {
      add_dataset(file, links, name, line);
    }
  }
  H5Pclose(links);
  H5Fclose(file);
}

}  // namespace ballast::fuzz
