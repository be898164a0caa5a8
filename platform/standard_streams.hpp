#pragma once

namespace ballast {

/// What every program of ours does first, before it opens a file:
///
/// - Standard input, output and error that were closed (`>&-`, a daemon) are opened on /dev/null.
///   The next file that is opened would otherwise get their number, and all that is printed would
///   land in it: in a log or in a record.
/// - A file that grows beyond the limit of `ulimit -f` is an error that names it (errno EFBIG), not
///   a death by SIGXFSZ without a word.
void prepare_standard_streams();

}  // namespace ballast
