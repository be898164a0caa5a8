#include "problems/algebra/known_masses.hpp"

#include <cstring>

namespace ballast {
namespace {

template <typename Number>
bool same_bits(const std::vector<Number>& x, const std::vector<Number>& y) {
  return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(Number)) == 0;
}

}  // namespace

bool KnownMasses::are_of(const DynamicsForm& dynamics) const {
  return same_bits(dof_begin_, dynamics.dof_begin) && same_bits(mass_begin_, dynamics.mass_begin) &&
         same_bits(mass_, dynamics.mass);
}

void KnownMasses::keep(const DynamicsForm& dynamics) {
  dof_begin_ = dynamics.dof_begin;
  mass_begin_ = dynamics.mass_begin;
  mass_ = dynamics.mass;
}

}  // namespace ballast
