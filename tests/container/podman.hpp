// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/container/base.hpp"

namespace cohort::test {

inline const std::string image = "localhost/cohort:" COHORT_VERSION;

/// podman with images, networks and settings of its own, in the build's folder: the machine's are left alone.
class Podman {
 public:
  explicit Podman(const std::filesystem::path& folder);

  Ended operator()(std::vector<std::string> arguments) const;
  /// podman-compose, on the same images, with variables of the compose files.
  Ended compose(std::vector<std::string> arguments, Process::Environment variables = {}) const;

  /// Takes away what `compose` has left of a project.
  void remove(const std::string& project) const;

  /// Why there are no containers here, or nothing. Imports the base of all images.
  std::optional<std::string> prepare(const std::filesystem::path& base) const;
  /// Builds a target of docker/Dockerfile. Uses the compiler cache and the npm registry of this machine.
  Ended build(const std::string& target, const std::string& tag) const;

 private:
  std::filesystem::path folder_;
  Process::Environment environment_;
};

/// Containers on a network and with a volume of their own; all gone with this.
class Containers {
 public:
  explicit Containers(const Podman& podman);
  Containers(const Containers&) = delete;
  Containers& operator=(const Containers&) = delete;
  ~Containers();

  /// Starts one of the image as docker/compose.yaml does: no rights, nothing to write to but /tmp and the volume.
  /// `options` are podman's, `command` is the image's.
  void start(const std::string& name, const std::vector<std::string>& options, const std::vector<std::string>& command);
  /// A host name `server` for the address of the container that was started as that.
  std::string server_host() const;
  /// Where this machine finds a port that was published, on the loopback.
  std::string published(const std::string& name, const std::string& port) const;
  /// Runs to its end in a container of its own.
  Ended run(const std::vector<std::string>& command) const;
  Ended execute(const std::string& name, const std::vector<std::string>& command) const;
  void kill(const std::string& name) const;
  void stop(const std::string& name) const;
  int wait(const std::string& name) const;
  std::string logs(const std::string& name) const;
  bool is_healthy(const std::string& name) const;

 private:
  std::string full(const std::string& name) const { return prefix_ + name; }
  std::vector<std::string> run_options() const;

  const Podman& podman_;
  std::string prefix_;
  std::vector<std::string> names_;
};

}  // namespace cohort::test
