// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cohort::tool {

// Exit codes of `cohort`, which docs/cli.md describes for users.
inline constexpr int exit_ok = 0;
inline constexpr int exit_failed = 1;      // the run failed, or its results could not be written
inline constexpr int exit_usage = 2;       // invalid command line, world, experiment or set-up: nothing was started
inline constexpr int exit_unrecorded = 4;  // with --record-or-stop: the recording failed
inline constexpr int exit_interrupted = 130;
/// The exit code of a view that `cohort run` has started: its page asks to run again.
inline constexpr int exit_run_again = 75;
// Exit code by which a host tells the `cohort run` that started it that another client now drives its robots.
inline constexpr int exit_superseded = 3;

}  // namespace cohort::tool
