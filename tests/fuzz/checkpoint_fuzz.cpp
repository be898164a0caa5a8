// A checkpoint. The input is the body of the sealed file and gets a valid checksum, so that the
// fuzzer passes that check. An accepted input is written as the same bytes.

#include "experiments/record/checkpoint.hpp"
#include "platform/pack.hpp"
#include "tests/fuzz/fuzz_file.hpp"

using namespace ballast;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr SealedKind kind{"BALLCKPT", "checkpoint", 1};
  const auto raw = fuzz::input_folder().write("raw.bin", fuzz::text_of(data, size));
  fuzz::refused_or(raw, [&] { read_checkpoint(raw); });

  const auto file = fuzz::input_folder().path() / "checkpoint.bin";
  write_sealed_file(file, kind, fuzz::text_of(data, size));
  fuzz::refused_or(file, [&] {
    const Checkpoint checkpoint = read_checkpoint(file);
    const auto copy = fuzz::input_folder().path() / "copy.bin";
    write_checkpoint(copy, checkpoint);
    if (read_sealed_file(copy, kind) != fuzz::text_of(data, size))
      fuzz::finding("written as other bytes");
  });
  return 0;
}
