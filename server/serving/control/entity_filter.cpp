// SPDX-License-Identifier: Apache-2.0
#include "server/serving/control/entity_filter.hpp"

#include <re2/re2.h>

#include <stdexcept>

namespace cohort::session {
namespace {

// POSIX extended syntax, with `\d`, `\w`, `\s` and `\b`, which the C library also supports.
RE2::Options options() {
  constexpr std::int64_t most_memory = std::int64_t{1} << 20;
  RE2::Options options;
  options.set_posix_syntax(true);
  options.set_perl_classes(true);
  options.set_word_boundary(true);
  options.set_one_line(true);  // ^ and $ are the ends of the name
  options.set_dot_nl(true);
  options.set_never_capture(true);
  options.set_log_errors(false);
  options.set_max_mem(most_memory);
  return options;
}

}  // namespace

struct EntityFilter::Compiled {
  explicit Compiled(const std::string& pattern) : expression(pattern, options()) {}
  RE2 expression;
};

EntityFilter::EntityFilter(const std::string& pattern) {
  constexpr std::size_t longest = 200;
  if (pattern.size() > longest) throw std::invalid_argument("a filter has at most 200 characters");
  if (pattern.empty()) return;
  auto compiled = std::make_unique<const Compiled>(pattern);
  if (!compiled->expression.ok())
    throw std::invalid_argument("'" + pattern + "' is not a regular expression: " + compiled->expression.error());
  compiled_ = std::move(compiled);
}

EntityFilter::~EntityFilter() = default;

bool EntityFilter::matches(const std::string& name) const {
  return compiled_ == nullptr || RE2::PartialMatch(name, compiled_->expression);
}

}  // namespace cohort::session
