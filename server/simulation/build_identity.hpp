#pragma once

#include <string>

namespace cohort {

/// Which build of Cohort ran: recordings and snapshots have it. What a file does not say is empty.
struct BuildIdentity {
  std::string version;
  std::string commit;      ///< `unknown` where no git told it; `-dirty` at its end if files had changed
  std::string arithmetic;  ///< `arithmetic_fingerprint`
};

/// Of this program. Any thread.
const BuildIdentity& this_build();

/// Returns a hash, as 16 hexadecimal digits, of what this build computes of fixed inputs: the portable functions,
/// random numbers, and bodies that fall, roll, turn and are driven, with every solver. The same on every CPU, as runs
/// are; two builds that differ in it give different results. Takes some milliseconds.
std::string arithmetic_fingerprint();

/// Returns a sentence if runs of that build have other results than those of this one, as far as is known; otherwise
/// nothing.
std::string why_results_differ(const BuildIdentity& other);

}  // namespace cohort
