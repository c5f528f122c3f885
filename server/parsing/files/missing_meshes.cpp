// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/files/missing_meshes.hpp"

#include <algorithm>
#include <cstdlib>

namespace cohort::parsing {
namespace {

MissingMesh named(const std::string& word) {
  if (word == "box") return MissingMesh::box;
  return word == "skip" ? MissingMesh::skip : MissingMesh::refused;
}

}  // namespace

MissingMesh replacement_of_mesh(InputFiles& input, const std::filesystem::path& folder, const std::string& uri) {
  std::string name = uri;
  std::ranges::replace(name, '/', '_');
  const std::filesystem::path kept = folder / "(missing meshes)" / name;
  if (!input.is_disk()) return input.is_file(kept) ? named(input.read(kept)) : MissingMesh::refused;
  const char* const word = std::getenv(missing_meshes_variable);
  const MissingMesh replacement = word != nullptr ? named(word) : MissingMesh::refused;
  if (replacement != MissingMesh::refused) input.add(kept, word);
  return replacement;
}

}  // namespace cohort::parsing
