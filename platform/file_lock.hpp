#pragma once
// One worker at a time: a lock that goes with its process, however that ends.

#include <filesystem>
#include <functional>
#include <string>

namespace ballast {

/// flock on a file that is made for it and removed with it. The kernel lets go when the process
/// dies, kill -9 included, and children that are another program don't inherit it. Over NFS it is a
/// lock among all machines that mount the folder.
class FileLock {
 public:
  /// Asks whether to go on waiting; called some twenty times a second.
  using Patience = std::function<bool(double seconds_waited)>;

  /// Waits until the lock is free; `patience` returning false gives up: is_held() is then false.
  /// The folder must be there. Throws Error when the file cannot be made or locked.
  FileLock(std::filesystem::path file, const Patience& patience);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  bool is_held() const { return descriptor_ >= 0; }
  /// Who holds the lock that could not be had: "process 123 on host", as far as the file says.
  const std::string& holder() const { return holder_; }

 private:
  bool try_once();
  void sign() const;

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::string holder_ = "another process";
};

/// For locks that are free unless somebody is at work: waits for one who is just dying.
bool briefly(double seconds_waited);

}  // namespace ballast
