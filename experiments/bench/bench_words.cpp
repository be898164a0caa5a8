#include "experiments/bench/bench_words.hpp"

#include <charconv>

namespace ballast {

std::vector<long> whole_numbers(const std::string& list, long most) {
  std::vector<long> numbers;
  for (size_t begin = 0; begin <= list.size();) {
    const size_t comma = std::min(list.find(',', begin), list.size());
    long number = 0;
    const auto [end, error] = std::from_chars(list.data() + begin, list.data() + comma, number);
    if (error != std::errc{} || end != list.data() + comma || number < 1 || number > most)
      throw std::invalid_argument("'" + list.substr(begin, comma - begin) +
                                  "': expected whole numbers from 1 to " + std::to_string(most) +
                                  ", separated by commas");
    numbers.push_back(number);
    begin = comma + 1;
  }
  return numbers;
}

}  // namespace ballast
