#include "platform/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <string>
#include <utility>

#include "platform/error.hpp"

namespace ballast {

namespace fs = std::filesystem;

void throw_file_error(const fs::path& file, std::string_view action) {
  const int error = errno;
  std::string message = file.string() + ": cannot " + std::string(action);
  if (error != 0) message += std::string(": ") + std::strerror(error);
  throw Error(message);
}

void sync_to_disk(std::FILE* stream, const fs::path& file) {
  errno = 0;
  // EINVAL, EROFS: pipes and special files, where there is nothing to sync
  if (std::fflush(stream) != 0 || (fsync(fileno(stream)) != 0 && errno != EINVAL && errno != EROFS))
    throw_file_error(file, "write");
}

void sync_folder(const fs::path& folder) {
  errno = 0;
  const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY);
  if (descriptor < 0) throw_file_error(folder, "open");
  fsync(descriptor);  // where a file system refuses it, the rename is as safe as it gets
  ::close(descriptor);
}

AtomicFile::AtomicFile(fs::path target) : target_(std::move(target)), neighbour_(target_) {
  neighbour_ += ".tmp";
  errno = 0;
  struct stat status;
  // Renaming over a folder fails only after all has been written; over a device it would replace
  // the device.
  if (stat(target_.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    throw Error(target_.string() + ": cannot write: it is not a regular file");
  file_ = std::fopen(neighbour_.c_str(), "wb");
  if (!file_) throw_file_error(target_, "write");
}

AtomicFile::~AtomicFile() {
  if (!file_) return;
  // There was no commit(): the target stays as it was.
  std::fclose(file_);
  std::remove(neighbour_.c_str());
}

void AtomicFile::write(const void* data, size_t bytes) {
  errno = 0;
  if (std::fwrite(data, 1, bytes, file_) != bytes) throw_file_error(target_, "write");
}

void AtomicFile::print(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  errno = 0;
  const int written = std::vfprintf(file_, format, arguments);
  va_end(arguments);
  if (written < 0) throw_file_error(target_, "write");
}

void AtomicFile::commit() {
  // The bytes are on the disk before the name points to them, and the name before commit() returns.
  sync_to_disk(file_, target_);
  close();
  if (std::rename(neighbour_.c_str(), target_.c_str()) != 0) {
    const int error = errno;
    std::remove(neighbour_.c_str());
    errno = error;
    throw_file_error(target_, "write");
  }
  sync_folder(target_.parent_path());
}

void AtomicFile::close() {
  errno = 0;
  if (std::fclose(std::exchange(file_, nullptr)) == 0) return;
  const int error = errno;
  std::remove(neighbour_.c_str());
  errno = error;
  throw_file_error(target_, "write");
}

void write_whole_file(const fs::path& target, std::string_view text) {
  AtomicFile file(target);
  file.write(text);
  file.commit();
}

std::string read_whole_file(const fs::path& path) {
  errno = 0;
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (!file) throw_file_error(path, "open");
  std::string text;
  char block[1 << 16];
  size_t got;
  while ((got = std::fread(block, 1, sizeof block, file)) > 0) text.append(block, got);
  const bool failed = std::ferror(file);
  const int error = errno;
  std::fclose(file);
  errno = error;
  if (failed) throw_file_error(path, "read");
  return text;
}

void create_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(folder.string() + ": cannot make the folder: " + error.message());
  if (!fs::is_directory(folder))
    throw Error(folder.string() + ": cannot make the folder: there is a file of that name");
}

}  // namespace ballast
