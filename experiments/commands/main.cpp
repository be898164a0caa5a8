// The ballast program: subcommands only, no physics. See commands/.

#include <iostream>

#include "experiments/commands/command.hpp"

int main(int argc, char** argv) { return ballast::ballast_main(argc, argv, std::cout, std::cerr); }
