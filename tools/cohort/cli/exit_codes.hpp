#pragma once

namespace cohort::tool {

// docs/cli.md tells users what these mean.
inline constexpr int exit_ok = 0;
inline constexpr int exit_failed = 1;      // the run ended with an error, or what it found could not be written
inline constexpr int exit_usage = 2;       // bad command line, world, experiment or set-up: nothing was started
inline constexpr int exit_unrecorded = 4;  // with --record-or-stop: the recording could not go on
inline constexpr int exit_interrupted = 130;
// Between `cohort run` and the hosts that it starts: somebody else drives its robots now.
inline constexpr int exit_superseded = 3;

}  // namespace cohort::tool
