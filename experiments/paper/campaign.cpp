#include "experiments/paper/campaign.hpp"

namespace ballast {
namespace {

constexpr double packing_seconds = 85.0;  // of one core, 1200 grains

}  // namespace

long Campaign::steps() const {
  long sum = 0;
  for (const CampaignRun& run : runs) sum += run.steps;
  return sum;
}

double Campaign::seconds() const {
  double sum = packing_seconds * packings;
  for (const CampaignRun& run : runs) sum += run.seconds;
  return sum;
}

}  // namespace ballast
