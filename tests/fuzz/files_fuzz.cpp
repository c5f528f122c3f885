// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <stdexcept>
#include <string>

#include "server/parsing/files/height_image.hpp"
#include "server/parsing/files/input_file.hpp"
#include "server/parsing/files/mesh_file.hpp"
#include "server/parsing/files/sample_file.hpp"

namespace {

using namespace cohort;

// What `read` says of a file of this name that has these bytes is of no interest.
template <class Read>
void try_to(const std::string& bytes, const std::string& name, Read&& read) {
  parsing::InputFiles input(std::make_shared<const description::KeptFiles>());
  input.add(name, bytes);
  try {
    read(input, name);
  } catch (const std::runtime_error&) {
  }
}

}  // namespace

/// Meshes, images and samples are read or refused with std::runtime_error.
// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it so.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const auto mesh = [](auto& input, const auto& file) {
    parsing::MeshReader().read(input, file, Eigen::Vector3d::Ones());
  };
  for (const char* const name : {"/a.obj", "/a.stl", "/a.dae", "/a.glb"}) try_to(bytes, name, mesh);
  try_to(bytes, "/a.png",
         [](auto& input, const auto& file) { parsing::read_height_image(input, file, Eigen::Vector3d::Ones()); });
  try_to(bytes, "/a.jpg", [](auto& input, const auto& file) { description::checked_image_size(input.read(file)); });
  try_to(bytes, "/a.csv", [](auto& input, const auto& file) { parsing::read_samples(input, file); });
  return 0;
}
