#pragma once

namespace ballast {

/// Exit codes of the ballast program.
enum class ExitCode { ok = 0, failure = 1, usage = 2, time_limit = 3, backend_missing = 4 };

}  // namespace ballast
