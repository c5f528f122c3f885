// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

/// Images that have a header but no pixels, for code that does not decode them.
namespace cohort::test {

inline std::string big_endian(std::uint32_t number, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(number >> (8 * i) & 0xffu);
  return text;
}

/// Returns the header of a PNG image. `end` distinguishes images of the same size.
inline std::string png_of(std::uint32_t width, std::uint32_t height, const std::string& end = "") {
  return "\x89PNG\r\n\x1a\n" + big_endian(13, 4) + "IHDR" + big_endian(width, 4) + big_endian(height, 4) + end;
}

inline std::string jpeg_of(std::uint32_t width, std::uint32_t height) {
  const std::string application = "\xff\xe0" + big_endian(4, 2) + "ab";
  const std::string tables = "\xff\xc4" + big_endian(3, 2) + "c";
  return "\xff\xd8" + application + tables + "\xff\xff\xc0" + big_endian(8, 2) + "\x08" + big_endian(height, 2) +
         big_endian(width, 2) + "\x01";
}

/// Returns a binary glTF file (.glb) of one triangle with texture coordinates (0, 0), (1, 0), (0, 1), measured from the
/// upper edge of the image. `image` is the JSON object of its image. If `view` is not empty, buffer view 3 contains it.
inline std::string glb_of(const std::string& image, const std::string& view = "") {
  const float numbers[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1};
  std::string buffer(reinterpret_cast<const char*>(numbers), sizeof numbers);
  buffer += std::string("\0\0\1\0\2\0\0\0", 8) + view;
  const std::string size = std::to_string(buffer.size());
  buffer.resize((buffer.size() + 3) / 4 * 4);
  std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.5,0,1,1],"baseColorTexture":{"index":0}}}],
"textures":[{"source":0}],"images":[)" +
      image + R"(],"accessors":[
{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"},
{"bufferView":2,"componentType":5123,"count":3,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},
{"buffer":0,"byteOffset":60,"byteLength":6})" +
      (view.empty() ? "" : R"(,{"buffer":0,"byteOffset":68,"byteLength":)" + std::to_string(view.size()) + "}") +
      R"(],"buffers":[{"byteLength":)" + size + "}]}";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto number = [](std::size_t value) {
    const auto bytes = big_endian(static_cast<std::uint32_t>(value), 4);
    return std::string(bytes.rbegin(), bytes.rend());
  };
  return "glTF" + number(2) + number(12 + 8 + json.size() + 8 + buffer.size()) + number(json.size()) + "JSON" + json +
         number(buffer.size()) + std::string("BIN\0", 4) + buffer;
}

}  // namespace cohort::test
