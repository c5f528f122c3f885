// SPDX-License-Identifier: Apache-2.0

// cohort-ros2-services: the endpoints of services for clients on Fast DDS (services/service_frames.hpp).

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <exception>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "tools/bridges/ros2/fastdds/domain.hpp"
#include "tools/bridges/ros2/fastdds/output.hpp"
#include "tools/bridges/ros2/fastdds/service.hpp"
#include "tools/bridges/ros2/services/service_frames.hpp"

namespace {

using namespace cohort::bridges::ros2;

constexpr int milliseconds_between_looks = 1000;  // at replies that are too old

// Handles each kind of frame from the bridge.
class Helper {
 public:
  explicit Helper(Output& output) : output_(output) {}
  Helper(const Helper&) = delete;
  Helper& operator=(const Helper&) = delete;
  ~Helper() { output_.close(); }  // a thread of DDS may wait there for the bridge

  void operator()(OpenDomain& open) {
    if (domain_) throw std::runtime_error("a domain is already open");
    domain_ = std::make_unique<Domain>(open);
    output_.send(DomainOpened{domain_->guid()});
  }
  void operator()(OfferService& offer) {
    if (services_.contains(offer.service))
      throw std::runtime_error("service " + std::to_string(offer.service) + " is offered twice");
    auto service = std::make_unique<Service>(domain(), output_, offer);
    output_.send(ServiceOffered{offer.service, service->request_reader(), service->reply_writer()});
    services_[offer.service] = std::move(service);
  }
  void operator()(SendReply& reply) {
    const auto service = services_.find(reply.service);
    if (service == services_.end())
      throw std::runtime_error("a reply for service " + std::to_string(reply.service) + ", which was not offered");
    service->second->reply(std::move(reply));
  }
  void operator()(Announce& announced) { domain().announce(std::move(announced)); }
  void drop_old_replies() {
    for (const auto& [number, service] : services_) service->drop_old_replies();
  }

 private:
  Domain& domain() {
    if (!domain_) throw std::runtime_error("no domain is open; expected OpenDomain first");
    return *domain_;
  }

  Output& output_;
  std::unique_ptr<Domain> domain_;
  std::map<std::uint32_t, std::unique_ptr<Service>> services_;
};

// Does what the bridge says until it closes the stream.
void serve(Output& output) {
  Helper helper(output);
  FrameStream<FrameToHelper> stream;
  std::array<char, 65536> buffer;
  for (;;) {
    pollfd waiting{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (::poll(&waiting, 1, milliseconds_between_looks) == 0) {
      helper.drop_old_replies();
      continue;
    }
    const ssize_t size = ::read(STDIN_FILENO, buffer.data(), buffer.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) break;
    stream.append({buffer.data(), static_cast<std::size_t>(size)});
    while (std::optional<FrameToHelper> frame = stream.next()) std::visit([&](auto& each) { helper(each); }, *frame);
  }
  if (stream.is_inside_frame()) throw std::runtime_error("the stream ends inside a frame");
}

}  // namespace

int main(int argc, char**) {
  if (argc > 1 || ::isatty(STDIN_FILENO) != 0) {
    std::cerr << "cohort-ros2-services is started by cohort-ros2-bridge, which sends it requests on standard input\n";
    return 2;
  }
  std::signal(SIGPIPE, SIG_IGN);
  // A terminal's Ctrl-C goes to the bridge too, which ends this when it has said good-bye.
  std::signal(SIGINT, SIG_IGN);
  // Nothing else may write into the stream, such as the log of Fast DDS.
  const int stream = ::dup(STDOUT_FILENO);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
  try {
    Output output(stream);
    serve(output);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "cohort-ros2-services: standard input: " << error.what() << '\n';
    return 1;
  }
}
