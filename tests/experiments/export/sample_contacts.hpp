#pragma once
// Contacts made up for exports: nothing in them is dynamics.

#include "tests/support/sample_run.hpp"

namespace ballast {

inline std::vector<ContactPoint> sample_contacts(int count) {
  Random random(8);
  std::vector<ContactPoint> contacts;
  for (int c = 0; c < count; ++c)
    contacts.push_back(
        {0, c + 1, 7, random_direction(random), random_direction(random), random.uniform(-1, 1)});
  return contacts;
}

}  // namespace ballast
