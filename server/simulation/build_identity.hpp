// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace cohort {

/// The build of Cohort that made a recording or snapshot. Unknown members are empty.
struct BuildIdentity {
  std::string version;
  std::string commit;      ///< `unknown` without git; with `-dirty` if files had changed
  std::string arithmetic;  ///< `arithmetic_fingerprint`
};

/// Returns the identity of this program. For any thread.
const BuildIdentity& this_build();

/// Returns the versions whose snapshots this version reads, oldest first; the last is this version. A version with
/// another layout of snapshots either reads the older layouts (`SnapshotLayout`) or leaves their versions out here.
std::span<const std::string_view> versions_of_snapshots();

/// Returns a hash, as 16 hexadecimal digits, of this build's results for fixed inputs: the portable functions, random
/// numbers, and falling, rolling, turning and driven bodies with every solver. It is the same on every CPU, like runs.
/// Two builds with different hashes produce different results. Takes some milliseconds.
std::string arithmetic_fingerprint();

/// Returns a sentence if runs of the other build are known to have different results from runs of this build; otherwise
/// an empty text.
std::string why_results_differ(const BuildIdentity& other);

}  // namespace cohort
