#pragma once
// The campaign as a dataset that can be cited: rows, plan, scenes, packings, a reader in Python.

#include "experiments/paper/paper_data.hpp"

namespace ballast {

struct ArchiveOrder {
  std::filesystem::path plan = {};  ///< the campaign's; empty: campaign.toml
  std::filesystem::path packings;   ///< where packings are kept: checksums of those that are there
  std::filesystem::path output;
};

/// Writes the folder `<output>/ballast-paper` and packs it as `<output>/ballast-paper.tar.gz`, the
/// same bytes from the same rows. Returns the packed file. Throws Error.
std::filesystem::path write_archive(PaperData& data, const ArchiveOrder& order);

}  // namespace ballast
