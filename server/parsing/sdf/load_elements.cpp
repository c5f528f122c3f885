#include "server/parsing/sdf/load_elements.hpp"

#include "server/parsing/sdf/schema/libsdformat_scope.hpp"
#include "server/parsing/sdf/sdf_errors.hpp"

namespace cohort::parsing {
namespace {

// Sets `loaded`.
std::vector<Problem> try_to_load(SdfFile& file, ElementBuilder& builder, const sdf::ParserConfig& config) {
  sdf::Errors errors;
  const auto failure = libsdformat_failure([&] {
    // Features of an old version remain allowed.
    const sdf::SDFPtr sdf = builder.build(file.tree, file.version, file.path, file.nodes, errors);
    file.loaded = sdf != nullptr;
    if (!sdf) return;
    const sdf::Errors more = file.root.Load(sdf, config);
    if (file.complete) errors.insert(errors.end(), more.begin(), more.end());  // otherwise they follow from that
  });
  if (failure) {
    file.loaded = false;
    return {{file.shown, 0, "", "libsdformat cannot read this file: " + *failure}};
  }
  return problems_of(errors, file);
}

}  // namespace

std::vector<Problem> load_elements(SdfFile& file, ElementBuilder& builder, const sdf::ParserConfig& config) {
  std::vector<Problem> found = try_to_load(file, builder, config);
  if (!file.loaded) {
    if (std::vector<Problem> values = replace_bad_values(file); !values.empty()) {
      found = try_to_load(file, builder, config);
      found.insert(found.begin(), values.begin(), values.end());
    }
  }
  file.sound = file.loaded && found.empty() && file.complete;
  return found;
}

}  // namespace cohort::parsing
