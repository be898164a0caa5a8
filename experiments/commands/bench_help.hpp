#pragma once

namespace ballast {

/// What `ballast bench --help` says after the options.
inline constexpr const char* bench_footer =
    R"(Results are <kind>.json and <kind>.csv with machine and commit; medians, means and quartiles.

Examples:
  ballast bench kernels                                     on 60 grains; vibrated_box: on 1200
  ballast bench step vibrated_box --steps 1000 --threads 1,2
  ballast bench scaling --grains 1000,10000,100000
  ballast bench accuracy vibrated_box --from 0.05 --duration 0.01 --solvers nncg,pgs \
    --iterations 20,50,100,200
  ballast bench diff old/step.json new/step.json)";

}  // namespace ballast
