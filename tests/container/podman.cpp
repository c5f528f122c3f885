// SPDX-License-Identifier: Apache-2.0
#include "tests/container/podman.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <functional>
#include <sstream>
#include <utility>

namespace cohort::test {
namespace {

namespace fs = std::filesystem;

// Where no registry can be reached, an image made from Debian's packages (make_base) has this name.
constexpr const char* base_image = "docker.io/library/debian:bookworm-slim";

void append(std::vector<std::string>& to, const std::vector<std::string>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

std::string npm_setting(const std::string& name) {
  return first_line(run_to_end({"/bin/sh", "-c", "npm config get " + name}).out);
}

// Returns options that give a build this machine's npm settings, and leave nothing of them in the image.
std::vector<std::string> with_settings_of_npm(const fs::path& folder) {
  if (!is_installed("npm")) return {};
  std::string settings = "registry=" + npm_setting("registry") + "\n";
  std::vector<std::string> options = {"--volume", (folder / "npmrc").string() + ":/root/.npmrc:ro"};
  if (const std::string authorities = npm_setting("cafile"); fs::is_regular_file(authorities)) {
    settings += "cafile=/root/.npm-authorities\n";
    append(options, {"--volume", authorities + ":/root/.npm-authorities:ro"});
  }
  write_file(folder / "npmrc", settings);
  return options;
}

}  // namespace

Podman::Podman(const fs::path& folder) : folder_(folder) {
  // podman wants a short path for what is gone when the machine starts again, and the same one each time.
  const std::string run_root = fmt::format("/run/cohort-test-{:x}", std::hash<std::string>{}(folder.string()));
  fs::create_directories(folder);
  write_file(folder / "storage.conf",
             fmt::format("[storage]\ndriver = \"overlay\"\ngraphroot = \"{}\"\nrunroot = \"{}\"\n",
                         (folder / "images").string(), run_root));
  fs::create_directories(folder / "networks");
  std::string settings = fmt::format("[network]\nnetwork_config_dir = \"{}\"\n", (folder / "networks").string());
  settings += "[containers]\ndefault_ulimits = [\"nofile=1024:1024\", \"nproc=1024:1024\"]\n[engine]\n";
  if (is_installed("runc")) settings += "runtime = \"runc\"\n";
  write_file(folder / "containers.conf", settings);
  environment_ = {{"CONTAINERS_STORAGE_CONF", folder / "storage.conf"},
                  {"CONTAINERS_CONF", folder / "containers.conf"}};
}

Ended Podman::operator()(std::vector<std::string> arguments) const {
  arguments.insert(arguments.begin(), {"podman", "--log-level", "fatal"});
  return run_for_long(arguments, environment_);
}

Ended Podman::compose(std::vector<std::string> arguments, Process::Environment variables) const {
  arguments.insert(arguments.begin(), "podman-compose");
  variables.insert(environment_.begin(), environment_.end());
  return run_for_long(arguments, variables);
}

void Podman::remove(const std::string& project) const {
  std::istringstream ids(
      (*this)({"ps", "--all", "--quiet", "--filter", "label=io.podman.compose.project=" + project}).out);
  for (std::string id; ids >> id;) (*this)({"rm", "--force", "--volumes", id});
  std::istringstream volumes(
      (*this)({"volume", "ls", "--quiet", "--filter", "label=io.podman.compose.project=" + project}).out);
  for (std::string volume; volumes >> volume;) (*this)({"volume", "rm", volume});
  (*this)({"network", "rm", project + "_robots"});
}

std::optional<std::string> Podman::prepare(const fs::path& base) const {
  const std::string name = base_image;
  if ((*this)({"image", "exists", name}).exit_code != 0) {
    const Ended imported = (*this)({"import", base / "bookworm-slim.tar", name});
    if (imported.exit_code != 0) return "podman keeps no images here: " + imported.out;
  }
  const Ended tried = (*this)({"run", "--rm", name, "true"});
  if (tried.exit_code != 0) return "podman runs no containers here: " + tried.out;
  return std::nullopt;
}

Ended Podman::build(const std::string& target, const std::string& tag) const {
  std::vector<std::string> arguments = {
      "build",    "--isolation", "chroot", "--network", "host", "--file", COHORT_SOURCE_DIR "/docker/Dockerfile",
      "--format", "docker"};
  const std::string cache = first_line(run_to_end({"/bin/sh", "-c", "ccache --get-config cache_dir"}).out);
  if (fs::is_directory(cache)) append(arguments, {"--volume", cache + ":/root/.cache/ccache"});
  if (const char* language = std::getenv("LANG"); language != nullptr)
    append(arguments, {"--build-arg", fmt::format("LANG={}", language)});
  append(arguments, with_settings_of_npm(folder_));
  append(arguments, {"--build-arg", std::string("BASE=") + base_image});
  append(arguments, {"--build-arg", "COHORT_COMMIT=of-the-test", "--target", target, "--tag", tag, COHORT_SOURCE_DIR});
  return (*this)(arguments);
}

Containers::Containers(const Podman& podman) : podman_(podman), prefix_(fmt::format("cohort-test-{}-", getpid())) {
  for (const char* kind : {"network", "volume"}) {
    const Ended made = podman_({kind, "create", full("shared")});
    if (made.exit_code != 0) throw std::runtime_error(made.out);
  }
}

Containers::~Containers() {
  for (const std::string& name : names_) podman_({"rm", "--force", "--volumes", "--time", "0", full(name)});
  for (const char* kind : {"network", "volume"}) podman_({kind, "rm", full("shared")});
}

std::vector<std::string> Containers::run_options() const {
  return {"--read-only",
          "--tmpfs",
          "/tmp",
          "--cap-drop",
          "ALL",
          "--security-opt",
          "no-new-privileges",
          "--network",
          full("shared"),
          "--volume",
          full("shared") + ":/var/lib/cohort"};
}

void Containers::start(const std::string& name, const std::vector<std::string>& options,
                       const std::vector<std::string>& command) {
  std::vector<std::string> arguments = {"run", "--detach", "--name", full(name), "--hostname", name};
  append(arguments, run_options());
  append(arguments, options);
  arguments.push_back(image);
  append(arguments, command);
  names_.push_back(name);
  const Ended started = podman_(arguments);
  if (started.exit_code != 0) throw std::runtime_error(started.out);
}

std::string Containers::server_host() const {
  const Ended found =
      podman_({"inspect", "--format", "{{range .NetworkSettings.Networks}}{{.IPAddress}}{{end}}", full("server")});
  return "server:" + first_line(found.out);
}

std::string Containers::published(const std::string& name, const std::string& port) const {
  const std::string address = first_line(podman_({"port", full(name), port}).out);
  if (!address.starts_with("127.0.0.1:")) throw std::runtime_error(name + " has published no port: " + address);
  return address.substr(address.find(':') + 1);
}

Ended Containers::run(const std::vector<std::string>& command) const {
  std::vector<std::string> arguments = {"run", "--rm"};
  append(arguments, run_options());
  arguments.push_back(image);
  append(arguments, command);
  return podman_(arguments);
}

Ended Containers::execute(const std::string& name, const std::vector<std::string>& command) const {
  std::vector<std::string> arguments = {"exec", full(name)};
  append(arguments, command);
  return podman_(arguments);
}

void Containers::kill(const std::string& name) const { podman_({"kill", full(name)}); }
void Containers::stop(const std::string& name) const { podman_({"stop", "--time", "60", full(name)}); }
int Containers::wait(const std::string& name) const { return std::stoi(podman_({"wait", full(name)}).out); }
std::string Containers::logs(const std::string& name) const { return podman_({"logs", full(name)}).out; }
bool Containers::is_healthy(const std::string& name) const {
  return podman_({"healthcheck", "run", full(name)}).exit_code == 0;
}

}  // namespace cohort::test
