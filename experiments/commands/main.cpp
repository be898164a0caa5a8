// The ballast program: subcommands only, no physics. See commands/.

#include <iostream>

#include <malloc.h>

#include "experiments/commands/command.hpp"
#include "platform/interrupt.hpp"

int main(int argc, char** argv) {
  // What vectors leave behind as they grow goes back to the system: left to adapt, the threshold
  // rises to their size, and a tenth of all memory lies idle.
  mallopt(M_MMAP_THRESHOLD, 128 * 1024);
  ballast::prepare_standard_streams();
  return ballast::ballast_main(argc, argv, std::cout, std::cerr);
}
