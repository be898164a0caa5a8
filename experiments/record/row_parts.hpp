#pragma once
// From a log of rows, which a run that may be killed writes, to datasets of the finished record.

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "platform/hdf5_file.hpp"
#include "platform/row_log.hpp"

namespace ballast {

/// The same numbers of every row, which become one dataset: readers mostly want one quantity over
/// all rows.
struct RowPart {
  std::string dataset;
  size_t begin = 0;      ///< first of the numbers in a row
  Hdf5Shape shape = {};  ///< of the part; {}: one number
  const char *unit = "", *description = "";
  Hdf5Number number = Hdf5Number::float64;
};

/// Adds a dataset (rows, shape) for each part, with its unit and description as attributes. All
/// safe rows are read, from the first; no more than a megabyte of them is in memory. `see` is
/// called with each. Throws Error.
void add_row_parts(Hdf5Writer& file, RowReader& rows, std::span<const RowPart> parts,
                   const std::function<void(std::span<const double> row)>& see = {});

}  // namespace ballast
