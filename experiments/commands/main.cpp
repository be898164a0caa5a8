// The ballast program: subcommands only, no physics. See command.hpp.

#include <iostream>

#include "experiments/commands/command.hpp"
#include "platform/interrupt.hpp"

int main(int argc, char** argv) {
  ballast::prepare_standard_streams();
  return ballast::ballast_main(argc, argv, std::cout, std::cerr);
}
