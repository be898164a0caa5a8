#pragma once

#include <filesystem>

#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

/// Bodies, walls and shapes as they were in the run that a record.h5 is of, whatever has become of
/// the files from which its scene had them. Gravity and friction are not in it. Throws Error.
MechanicalSystem read_record_system(const std::filesystem::path& record);

}  // namespace ballast
