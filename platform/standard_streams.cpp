#include "platform/standard_streams.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <initializer_list>

namespace ballast {

void prepare_standard_streams() {
  // open() takes the lowest number that is free: what is below is open by then.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) == -1 && open("/dev/null", O_RDWR) != stream) break;
  signal(SIGXFSZ, SIG_IGN);
}

}  // namespace ballast
