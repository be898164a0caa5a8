#pragma once
// A list of numbers >= 0 that takes two bytes each while all are small.

#include <cstdint>
#include <vector>

namespace ballast {

/// Of features of a shape: ordinary grains have some dozen, a mesh may have a hundred thousand.
class ShortNumbers {
 public:
  /// `numbers`: all of them; they do not change any more.
  void keep(const std::vector<int>& numbers) {
    bool is_short = true;
    for (const int number : numbers) is_short = is_short && number <= UINT16_MAX;
    short_.clear();
    long_.clear();
    if (is_short)
      short_.assign(numbers.begin(), numbers.end());
    else
      long_ = numbers;
    short_.shrink_to_fit();
    long_.shrink_to_fit();
  }
  int operator[](int k) const { return long_.empty() ? short_[k] : long_[k]; }
  int size() const { return static_cast<int>(short_.size() + long_.size()); }

 private:
  std::vector<std::uint16_t> short_;
  std::vector<int> long_;
};

}  // namespace ballast
