#pragma once
// Words for the tables of scene keys: number(&Spec::member, range, unit) and its like.

#include "problems/scene/scene_keys.hpp"

namespace ballast {

template <class Spec>
KeptValue<NumberKind, Spec> number(double Spec::*member, const NumberRange& range,
                                   const char* unit = "") {
  return {{range, unit}, member};
}
template <class Spec>
KeptValue<WholeKind, Spec> whole(int Spec::*member, int low, int high = WholeKind::no_limit) {
  return {{low, high}, member};
}
template <class Spec>
KeptValue<SeedKind, Spec> seed(std::uint64_t Spec::*member) {
  return {{}, member};
}
template <class Spec>
KeptValue<FlagKind, Spec> flag(bool Spec::*member) {
  return {{}, member};
}
template <class Spec>
KeptValue<TextKind, Spec> text(std::string Spec::*member) {
  return {{}, member};
}
template <class Spec>
KeptValue<ChoiceKind, Spec> choice(std::string Spec::*member, std::vector<const char*> words) {
  return {{std::move(words)}, member};
}
template <class Spec>
KeptValue<VectorKind, Spec> vector(Vec3 Spec::*member, const char* unit = "") {
  return {{unit}, member};
}
template <class Spec>
KeptValue<TextsKind, Spec> texts(std::vector<std::string> Spec::*member) {
  return {{}, member};
}

}  // namespace ballast
