#pragma once
// Lists of numbers on the command line of `ballast bench`.

#include <stdexcept>
#include <string>
#include <vector>

namespace ballast {

/// "1000,10000": whole numbers from 1 to `most`. Throws std::invalid_argument saying what was
/// expected.
std::vector<long> whole_numbers(const std::string& list, long most);

}  // namespace ballast
