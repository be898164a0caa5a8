#pragma once
// What comes out today: every table of the golden file, computed in this process in a few seconds.

#include "tests/golden/golden_file.hpp"

namespace ballast::golden {

/// sine, cosine, hypot and pow of some thousand arguments.
Table libm_values();

/// Grains of vibrated_box_small as they are made: hulls, masses, moments of inertia.
Table grain_values();

/// Of the backends that factor over bodies: SuiteSparse finds the order for them.
inline constexpr char factoring_table[] = "backends_factoring";

/// One step of a heap whose bits go through arithmetic alone: its grains do not turn before the
/// step, overlap, and fly at each other. Contacts and problem as arrays; then what each backend of
/// our own makes of the problem in a fixed number of iterations, own factors over bodies included.
std::vector<Table> heap_values();

/// A small box of vibrated_box_small: its deposit, its packing, its drive.
std::vector<Table> box_values();

/// All of them, in the order in which one is made from the other.
File values_today();

}  // namespace ballast::golden
