// SPDX-License-Identifier: Apache-2.0
#include "tools/view/web/web_server.hpp"

#include <algorithm>
#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <fstream>
#include <iterator>
#include <list>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "tools/view/web/admission.hpp"
#include "tools/view/web/client_session.hpp"

namespace cohort::view {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using beast::error_code;

constexpr std::size_t most_pages = 64;    // connections that ask for files
constexpr std::size_t most_viewers = 64;  // WebSockets: of those who may
constexpr std::chrono::milliseconds before_accepting_again{100};
constexpr std::size_t largest_message = std::size_t{1} << 20;  // from a client [bytes]
constexpr std::uint32_t largest_header = 8192;
constexpr std::chrono::seconds request_time{10};
constexpr bool has_compression = false;  // off unless asked for, and long to compile

constexpr const char* policy_but_for_frames =
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
    "connect-src 'self' ws: wss:; media-src blob:; base-uri 'none'; form-action 'none'; frame-ancestors ";

using Request = http::request<http::empty_body>;
using Response = http::response<http::string_body>;

std::string text_of(boost::string_view view) { return {view.data(), view.size()}; }

Visitor visitor_of(const Request& request) {
  Visitor visitor{text_of(request[http::field::host]), std::nullopt, text_of(request.target())};
  if (const auto origin = request.find(http::field::origin); origin != request.end())
    visitor.origin = text_of(origin->value());
  return visitor;
}

}  // namespace

// State shared by connections.
class WebServer::State {
 public:
  State(WebOptions asked, PageFiles files, Topics& published_topics)
      : options(std::move(asked)),
        page(std::move(files)),
        topics(published_topics),
        content_policy(policy_but_for_frames + options.frame_ancestors),
        acceptor(context) {}

  class WebSocket;
  class Page;

  void listen();
  error_code listen(const tcp::endpoint& endpoint);
  void accept();
  void give_way();
  // Several calls before the thread comes to it are one.
  void published() {
    if (is_pumping.exchange(true)) return;
    asio::post(context, [this] { pump(); });
  }
  void pump();
  void watch();

  const WebOptions options;
  const PageFiles page;
  Topics& topics;
  const std::string content_policy;
  Admission admission;
  const std::string session = random_token();
  std::atomic<bool> is_pumping{false};
  std::set<WebSocket*> clients;
  std::list<Page*> pages;      // in the order of their last request
  std::uint64_t visitors = 0;  // that there have been
  Source* source = nullptr;
  asio::io_context context{1};  // with it go the connections, which need all that is above
  tcp::acceptor acceptor;
  asio::steady_timer pause{context};  // pause between attempts to accept
};

// One that has become a WebSocket. Alive while something is under way on it.
class WebServer::State::WebSocket : public std::enable_shared_from_this<WebSocket> {
 public:
  WebSocket(State& state, tcp::socket socket)
      : state_(state),
        stream_(std::move(socket)),
        session_(state.topics, state.options.name, state.session,
                 {[this](const protocol::ServiceCall& call, const ViewRequest& request) { ask(call, request); },
                  [this] { state_.watch(); }}) {
    state_.clients.insert(this);
  }
  ~WebSocket() {
    state_.clients.erase(this);
    if (!session_.watched().empty()) state_.watch();
    if (state_.source != nullptr) state_.source->leave(visitor_);
  }
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  void accept(const Request& request) {
    stream_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    stream_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, protocol::subprotocol);
    }));
    stream_.read_message_max(largest_message);
    stream_.auto_fragment(false);
    stream_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return;
      self->is_open_ = true;
      self->read();
      self->pump();
    });
  }

  // Sends what is next, unless something is under way.
  void pump() {
    if (!is_open_ || is_writing_) return;
    outgoing_ = session_.next();
    if (!outgoing_) return;
    is_writing_ = true;
    std::visit([this](const auto& each) { write(each); }, *outgoing_);
  }

  const std::vector<std::uint32_t>& watched() const { return session_.watched(); }

 private:
  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) { self->have_read(error); });
  }
  void have_read(error_code error) {
    if (error) return;
    const auto* const data = static_cast<const char*>(buffer_.data().data());
    if (stream_.got_text())
      session_.take_text({data, buffer_.size()});
    else
      session_.take_binary(std::as_bytes(std::span(data, buffer_.size())));
    buffer_.consume(buffer_.size());
    pump();
    read();
  }
  void write(const ClientSession::Text& text) { send(false, std::array{asio::buffer(text.text)}); }
  void write(const recording::Bytes& bytes) { send(true, std::array{asio::buffer(bytes)}); }
  void write(const ClientSession::Data& data) {
    send(true, std::array{asio::buffer(data.head), asio::buffer(data.published->data)});
  }
  template <class Buffers>
  void send(bool is_binary, const Buffers& buffers) {
    stream_.binary(is_binary);
    stream_.async_write(buffers, [self = shared_from_this()](error_code error, std::size_t) {
      self->is_writing_ = false;
      self->is_open_ = self->is_open_ && !error;
      self->pump();
    });
  }
  // The answer may come from any thread, and when this has gone.
  void ask(const protocol::ServiceCall& call, const ViewRequest& request) {
    ViewRequest theirs = request;
    theirs.visitor = visitor_;
    state_.source->ask(theirs, [&state = state_, weak = weak_from_this(), call](const Answer& answer) {
      asio::post(state.context, [weak, call, answer] {
        const auto self = weak.lock();
        if (self == nullptr) return;
        self->session_.respond(call, answer);
        self->pump();
      });
    });
  }

  State& state_;
  const std::uint64_t visitor_ = ++state_.visitors;
  websocket::stream<beast::tcp_stream, has_compression> stream_;
  beast::flat_buffer buffer_;
  ClientSession session_;
  std::optional<ClientSession::Outgoing> outgoing_;  // lives while it is written
  bool is_open_ = false;
  bool is_writing_ = false;
};

// One that asks for files of the page, until it wants to be a WebSocket.
class WebServer::State::Page : public std::enable_shared_from_this<Page> {
 public:
  Page(State& state, tcp::socket socket) : state_(state), stream_(std::move(socket)) {
    error_code unknown;
    address_ = stream_.socket().remote_endpoint(unknown).address();
    place_ = state_.pages.insert(state_.pages.end(), this);
  }
  ~Page() { state_.pages.erase(place_); }
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  const asio::ip::address& address() const { return address_; }
  void close() {
    error_code unknown;
    stream_.socket().close(unknown);
  }
  void read() {
    state_.pages.splice(state_.pages.end(), state_.pages, place_);
    parser_.emplace();
    parser_->header_limit(largest_header);
    parser_->body_limit(std::uint64_t{0});
    stream_.expires_after(request_time);
    http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](error_code error, std::size_t) {
      if (!error) self->answer(self->parser_->release());
    });
  }

 private:
  void answer(const Request& request) {
    const Visitor visitor = visitor_of(request);
    if (websocket::is_upgrade(request)) {
      if (const auto why = refusal(state_.admission, visitor)) return send(request, http::status::forbidden, *why);
      if (state_.clients.size() >= most_viewers)
        return send(request, http::status::service_unavailable, "too many viewers are connected");
      stream_.expires_never();
      std::make_shared<WebSocket>(state_, stream_.release_socket())->accept(request);
      return;
    }
    if (!is_own_host(state_.admission, visitor.host))
      return send(request, http::status::forbidden, "this server accepts only browsers on its own machine");
    if (request.method() != http::verb::get && request.method() != http::verb::head)
      return send(request, http::status::method_not_allowed, "only GET and HEAD are allowed");
    const auto found = state_.page.find(visitor.target.substr(0, visitor.target.find('?')));
    if (found == state_.page.end()) return send(request, http::status::not_found, "not found");
    send(request, http::status::ok, found->second.content, found->second.type);
  }

  void send(const Request& request, http::status status, const std::string& content,
            const std::string& type = "text/plain") {
    response_ = Response(status, request.version());
    response_.set(http::field::content_type, type + "; charset=utf-8");
    response_.set(http::field::cache_control, "no-store");
    response_.set("Content-Security-Policy", state_.content_policy);
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Referrer-Policy", "no-referrer");
    response_.keep_alive(request.keep_alive());
    response_.content_length(content.size());
    if (request.method() != http::verb::head) response_.body() = content;
    http::async_write(stream_, response_, [self = shared_from_this()](error_code error, std::size_t) {
      if (!error && self->response_.keep_alive()) self->read();
    });
  }

  State& state_;
  asio::ip::address address_;
  std::list<Page*>::iterator place_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> parser_;
  Response response_;
};

void WebServer::State::listen() {
  const auto fail = [&](const error_code& error) {
    throw std::runtime_error("cannot listen on " + options.address + ", port " + std::to_string(options.port) + ": " +
                             error.message() + "; choose another port");
  };
  error_code error;
  const asio::ip::address address = asio::ip::make_address(options.address, error);
  if (error) fail(error);
  error = listen({address, options.port});
  if (error && options.or_any_free_port) error = listen({address, 0});
  if (error) fail(error);
  admission = {address.is_loopback(), options.token, options.origins};
}

error_code WebServer::State::listen(const tcp::endpoint& endpoint) {
  error_code error;
  acceptor = tcp::acceptor(context);
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  return error;
}

void WebServer::State::accept() {
  acceptor.async_accept([this](error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (error) {  // no more files may be open: that does not end at once
      if (!pages.empty()) give_way();
      pause.expires_after(before_accepting_again);
      return pause.async_wait([this](error_code ended) {
        if (!ended) accept();
      });
    }
    if (pages.size() >= most_pages) give_way();
    std::make_shared<Page>(*this, std::move(socket))->read();
    accept();
  });
}

// Makes room for a new connection. Among those of the address that holds most connections, it closes the one that was
// used longest ago, so that a client that opens many closes only its own. WebSockets stay.
void WebServer::State::give_way() {
  std::map<asio::ip::address, std::size_t> held;
  for (const Page* const each : pages) ++held[each->address()];
  const std::size_t most = std::ranges::max_element(held, {}, [](const auto& each) { return each.second; })->second;
  (*std::ranges::find_if(pages, [&](const Page* each) { return held[each->address()] == most; }))->close();
}

void WebServer::State::pump() {
  is_pumping = false;
  for (WebSocket* const client : clients) client->pump();
}

void WebServer::State::watch() {
  std::set<std::uint32_t> watched;
  for (const WebSocket* const client : clients) watched.insert(client->watched().begin(), client->watched().end());
  if (source != nullptr) source->watch({watched.begin(), watched.end()});
}

WebServer::WebServer(WebOptions options, PageFiles page, Topics& topics)
    : state_(std::make_unique<State>(std::move(options), std::move(page), topics)) {
  state_->listen();
}

WebServer::~WebServer() = default;

std::uint16_t WebServer::port() const { return state_->acceptor.local_endpoint().port(); }

void WebServer::published() { state_->published(); }

void WebServer::run(Source& source) {
  state_->source = &source;
  state_->accept();
  state_->context.run();
  state_->source = nullptr;
}

void WebServer::stop() { state_->context.stop(); }

PageFiles read_page(const std::filesystem::path& folder) {
  constexpr std::array<std::pair<const char*, const char*>, 3> files = {
      std::pair{"index.html", "text/html"}, {"page.js", "text/javascript"}, {"page.css", "text/css"}};
  PageFiles page;
  for (const auto& [name, type] : files) {
    std::ifstream in(folder / name, std::ios::binary);
    if (!in.is_open()) return {};
    page[std::string("/") + name] = {type, {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()}};
  }
  page["/"] = page.at("/index.html");
  return page;
}

}  // namespace cohort::view
