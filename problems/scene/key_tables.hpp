#pragma once
// Words for the tables of scene keys: number(&Spec::member, range, unit) and its like.

#include "problems/scene/scene_keys.hpp"

namespace ballast {

template <class Kind, class Spec>
std::shared_ptr<const KeyValue<Spec>> kept_value(Kind kind, typename Kind::Value Spec::*member) {
  return std::make_shared<KeptValue<Kind, Spec>>(std::move(kind), member);
}

template <class Spec>
std::shared_ptr<const KeyValue<Spec>> number(double Spec::*member, const NumberRange& range,
                                             const char* unit = "") {
  return kept_value(NumberKind{range, unit}, member);
}
template <class Spec>
std::shared_ptr<const KeyValue<Spec>> whole(int Spec::*member, int low,
                                            int high = WholeKind::no_limit) {
  return kept_value(WholeKind{low, high}, member);
}
template <class Spec>
std::shared_ptr<const KeyValue<Spec>> seed(std::uint64_t Spec::*member) {
  return kept_value(SeedKind{}, member);
}
template <class Spec>
std::shared_ptr<const KeyValue<Spec>> flag(bool Spec::*member) {
  return kept_value(FlagKind{}, member);
}
template <class Spec>
std::shared_ptr<const KeyValue<Spec>> text(std::string Spec::*member) {
  return kept_value(TextKind{}, member);
}
template <class Spec>
std::shared_ptr<const KeyValue<Spec>> choice(std::string Spec::*member,
                                             std::vector<const char*> words) {
  return kept_value(ChoiceKind{std::move(words)}, member);
}
template <class Spec>
std::shared_ptr<const KeyValue<Spec>> vector(Vec3 Spec::*member, const char* unit = "") {
  return kept_value(VectorKind{unit}, member);
}
template <class Spec>
std::shared_ptr<const KeyValue<Spec>> texts(std::vector<std::string> Spec::*member) {
  return kept_value(TextsKind{}, member);
}

}  // namespace ballast
