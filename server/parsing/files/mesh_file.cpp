// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/files/mesh_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "server/parsing/files/mesh_import.hpp"

namespace cohort::parsing {
namespace {

// Messages of the importer process. A question is followed by the name of a file; the answer is a byte or the content.
enum class Message : std::uint8_t { asks_whether_file, asks_for_content, mesh, error };

constexpr std::uint64_t longest_text = 1u << 16;  // [bytes]
constexpr std::uint64_t no_content = ~std::uint64_t{0};

// An invalid message of the importer, whose memory is corrupt.
struct Garbled : std::runtime_error {
  Garbled() : std::runtime_error("sent invalid mesh data") {}
};

void send_text(ChildStream& stream, const std::string& text, std::uint64_t longest = longest_text) {
  const std::uint64_t size = std::min<std::uint64_t>(text.size(), longest);
  stream.send(size);
  stream.send(text.data(), size);
}

std::string receive_text(ChildStream& stream, std::uint64_t longest = longest_text) {
  const auto size = stream.receive<std::uint64_t>();
  if (size > longest) throw Garbled();
  std::string text(size, '\0');
  stream.receive(text.data(), size);
  return text;
}

template <class Item>
void send_items(ChildStream& stream, const std::vector<Item>& items) {
  stream.send(std::uint64_t{items.size()});
  stream.send(items.data(), items.size() * sizeof(Item));
}

template <class Item>
std::vector<Item> receive_items(ChildStream& stream) {
  const auto count = stream.receive<std::uint64_t>();
  if (count > ChildLimits().memory / sizeof(Item)) throw Garbled();  // it cannot have had so many
  std::vector<Item> items(count);
  stream.receive(items.data(), count * sizeof(Item));
  return items;
}

// ---- In the importer's process ----

// The files come from the parent, which keeps what it reads.
class SourcesOfParent : public MeshSources {
 public:
  SourcesOfParent(ChildStream& stream, std::string file, std::string content)
      : stream_(stream), file_(std::move(file)), content_(std::move(content)) {}

  bool is_file(const std::string& file) override {
    if (file == file_) return true;
    ask(Message::asks_whether_file, file);
    return stream_.receive<bool>();
  }
  const std::string* read(const std::string& file) override {
    if (file == file_) return &content_;
    ask(Message::asks_for_content, file);
    const auto size = stream_.receive<std::uint64_t>();
    if (size == no_content) return nullptr;
    std::string content(size, '\0');
    stream_.receive(content.data(), size);
    return &others_.insert_or_assign(file, std::move(content)).first->second;
  }

 private:
  void ask(Message question, const std::string& file) {
    stream_.send(question);
    send_text(stream_, file);
  }

  ChildStream& stream_;
  std::string file_;
  std::string content_;
  std::map<std::string, std::string> others_;
};

void import_and_send(ChildStream& stream) {
  const auto scale = stream.receive<std::array<double, 3>>();
  const auto is_centered = stream.receive<bool>();
  const std::string submesh = receive_text(stream);
  const std::string file = receive_text(stream);
  SourcesOfParent sources(stream, file, receive_text(stream, std::numeric_limits<std::uint64_t>::max()));
  try {
    const ImportedMesh mesh = import_mesh(sources, file, Eigen::Vector3d(scale.data()), {submesh, is_centered});
    stream.send(Message::mesh);
    send_items(stream, mesh.vertices);
    send_items(stream, mesh.triangles);
    send_items(stream, mesh.colors);
    send_items(stream, mesh.textures.coordinates);
    send_items(stream, mesh.textures.of_triangles);
    stream.send(std::uint64_t{mesh.images.size()});
    for (const MeshImage& image : mesh.images) {
      send_text(stream, image.name);
      send_text(stream, image.bytes, most_image_bytes);
    }
  } catch (const std::runtime_error& error) {
    stream.send(Message::error);
    send_text(stream, error.what());
  }
}

// ---- In this process ----

void check_format(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  for (const char* const known : {".stl", ".obj", ".dae", ".glb", ".gltf"})
    if (extension == known) return;
  throw std::runtime_error("'" + file.string() +
                           "' has an unsupported format; expected .stl, .obj, .dae, .glb or .gltf");
}

// Receives the end of a mesh.
void receive_textures(ChildStream& stream, ImportedMesh& mesh) {
  MeshTextures& textures = mesh.textures;
  textures.coordinates = receive_items<std::array<std::array<float, 2>, 3>>(stream);
  textures.of_triangles = receive_items<std::uint32_t>(stream);
  const auto images = stream.receive<std::uint64_t>();
  if (images > mesh.triangles.size()) throw Garbled();  // each is on a triangle
  for (std::uint64_t i = 0; i < images; ++i) {
    std::string name = receive_text(stream);
    mesh.images.push_back({std::move(name), receive_text(stream, most_image_bytes)});
  }
  const auto has_image = [&](std::uint32_t image) { return image == MeshTextures::none || image < images; };
  const auto has_size = [&](std::size_t size) { return size == 0 || size == mesh.triangles.size(); };
  if (!has_size(textures.coordinates.size()) || !has_size(textures.of_triangles.size()) ||
      !std::ranges::all_of(textures.of_triangles, has_image))
    throw Garbled();
}

ImportedMesh receive_mesh(ChildStream& stream) {
  ImportedMesh mesh;
  mesh.vertices = receive_items<Eigen::Vector3d>(stream);
  mesh.triangles = receive_items<std::array<std::uint32_t, 3>>(stream);
  mesh.colors = receive_items<std::array<std::uint8_t, 3>>(stream);
  const auto is_finite = [](const Eigen::Vector3d& vertex) { return vertex.allFinite(); };
  const auto has_vertices = [&](const std::array<std::uint32_t, 3>& triangle) {
    return std::ranges::all_of(triangle, [&](std::uint32_t vertex) { return vertex < mesh.vertices.size(); });
  };
  if (mesh.triangles.empty() || !std::ranges::all_of(mesh.vertices, is_finite) ||
      !std::ranges::all_of(mesh.triangles, has_vertices) ||
      (!mesh.colors.empty() && mesh.colors.size() != mesh.triangles.size()))
    throw Garbled();
  receive_textures(stream, mesh);
  return mesh;
}

void send_content(ChildStream& stream, InputFiles& input, const std::string& file) {
  if (input.why_unreadable(file)) return stream.send(no_content);
  const std::string& content = input.read(file);
  stream.send(std::uint64_t{content.size()});
  stream.send(content.data(), content.size());
}

// Answers the importer until it sends the mesh or an error.
ImportedMesh answer_until_mesh(ChildStream& stream, InputFiles& input) {
  while (true) {
    switch (stream.receive<Message>()) {
      case Message::asks_whether_file: stream.send(input.is_file(receive_text(stream))); break;
      case Message::asks_for_content: send_content(stream, input, receive_text(stream)); break;
      case Message::mesh: return receive_mesh(stream);
      case Message::error: throw std::runtime_error(receive_text(stream));
      default: throw Garbled();
    }
  }
}

const std::string& content_of(InputFiles& input, const std::filesystem::path& file) {
  if (const std::optional<std::string> reason = input.why_unreadable(file))
    throw std::runtime_error("'" + file.string() + "' cannot be read: " + *reason);
  return input.read(file);
}

}  // namespace

ImportedMesh MeshReader::read(InputFiles& input, const std::filesystem::path& file, const Eigen::Vector3d& scale,
                              const MeshPart& which) {
  check_format(file);
  const std::string& content = content_of(input, file);
  // Kept for the next file only if this one is read: otherwise, half a message may be on its way.
  std::unique_ptr<LimitedChild> importer = std::move(importer_);
  if (!importer) importer = std::make_unique<LimitedChild>(ChildLimits(), &import_and_send, LimitedChild::Times::many);
  const auto failed = [&](const std::string& why) {
    return ImporterFailed("'" + file.string() + "' cannot be imported: the importer " + why);
  };
  ChildStream& stream = importer->stream();
  try {
    importer->begin();
    stream.send(std::array{scale.x(), scale.y(), scale.z()});
    stream.send(which.is_centered);
    send_text(stream, which.submesh);
    send_text(stream, file.string());
    send_text(stream, content, content.size());
    ImportedMesh mesh = answer_until_mesh(stream, input);
    importer_ = std::move(importer);
    return mesh;
  } catch (const ChildStream::Lost&) {
    throw failed(importer->end());
  } catch (const Garbled& error) {
    throw failed(error.what());
  }
}

}  // namespace cohort::parsing
