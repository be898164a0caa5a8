#include "experiments/record/row_parts.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

namespace ballast {

void add_row_parts(Hdf5Writer& file, RowReader& rows, std::span<const RowPart> parts,
                   const std::function<void(std::span<const double> row)>& see) {
  const auto count = static_cast<size_t>(rows.safe_count());
  std::vector<Hdf5Id> datasets;
  for (const RowPart& part : parts) {
    Hdf5Shape shape = part.shape;
    shape.insert(shape.begin(), count);
    datasets.push_back(file.add_rows(part.dataset, shape, part.number));
    file.add_attribute(part.dataset, "unit", part.unit);
    file.add_attribute(part.dataset, "description", part.description);
  }
  constexpr size_t most_numbers = 1 << 17;  // that are gathered: a megabyte
  const size_t length = rows.header().row_size,
               most_rows = std::max<size_t>(1, most_numbers / length);
  std::vector<double> gathered, values;
  rows.rewind();
  for (size_t first = 0; first < count; first += gathered.size() / length) {
    // as many rows as may be gathered
    gathered.clear();
    for (size_t k = first; k < std::min(count, first + most_rows); ++k) {
      const std::span<const double> row = rows.next();
      gathered.insert(gathered.end(), row.begin(), row.end());
      if (see) see(row);
    }
    // part by part from all of them
    for (size_t p = 0; p < parts.size(); ++p) {
      const Hdf5Shape& shape = parts[p].shape;
      const auto size = std::accumulate(shape.begin(), shape.end(), size_t{1}, std::multiplies<>());
      values.clear();
      for (size_t at = parts[p].begin; at < gathered.size(); at += length)
        values.insert(values.end(), gathered.data() + at, gathered.data() + at + size);
      file.write_rows(datasets[p], first, values);
    }
  }
}

}  // namespace ballast
