// A stored row of a comparison, as JSON: the input as it is, and as changes of a whole row. An
// accepted row is written as a text that is read back as the same text.

#include <nlohmann/json.hpp>

#include "experiments/compare/compare_row.hpp"
#include "tests/fuzz/fuzz_file.hpp"

using namespace ballast;

namespace {

void read_row(const std::string& json) {
  const std::string file = "row.json";
  fuzz::refused_or(file, [&] {
    const CompareRow row = compare_row_of_json(json, file);
    const std::string text = to_json(row);
    if (to_json(compare_row_of_json(text, file)) != text)
      fuzz::finding("the written row reads back as another");
    compare_csv(std::vector{row});
  });
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string input(fuzz::text_of(data, size));
  read_row(input);
  const auto changes = nlohmann::ordered_json::parse(input, nullptr, false);
  if (!changes.is_object()) return 0;
  auto row = nlohmann::ordered_json::parse(to_json(CompareRow{}));
  row.update(changes);
  read_row(row.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  return 0;
}
