// One thread, one event loop (Boost.Beast): connections take turns, and each has at most one answer on its way.
#include "apps/lendulet/view/server.h"

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <filesystem>
#include <memory>
#include <optional>

#include "io/file.h"

namespace lendulet::cli {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Tcp = asio::ip::tcp;
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;

namespace {

constexpr auto patience = std::chrono::seconds(30);  // for a request to come, or an answer to be taken
constexpr int most_connections = 64;

// What all connections share.
struct Shared {
    const ServerOptions& options;
    const OpenScene& open;
    uint16_t port;
    int connections = 0;
    bool ever_connected = false;
};

struct Counted {
    std::shared_ptr<Shared> shared;
    explicit Counted(std::shared_ptr<Shared> s) : shared(std::move(s)) { ++shared->connections; }
    ~Counted() { --shared->connections; }
    Counted(const Counted&) = delete;
    Counted& operator=(const Counted&) = delete;
};

bool is_ours(beast::string_view host, uint16_t port) {
    const std::string number = ":" + std::to_string(port);
    for (const char* name : {"localhost", "127.0.0.1"})
        if (host == name + number || (port == 80 && host == name)) return true;
    return false;
}

bool is_own_page(const Request& request, uint16_t port) {
    const beast::string_view origin = request[http::field::origin], scheme = "http://";
    return origin.starts_with(scheme) && is_ours(origin.substr(scheme.size()), port);
}

const char* type_of(const std::string& name) {
    static constexpr std::pair<const char*, const char*> types[] = {{".html", "text/html; charset=utf-8"},
                                                                    {".js", "text/javascript"},
                                                                    {".css", "text/css"},
                                                                    {".svg", "image/svg+xml"},
                                                                    {".wasm", "application/wasm"},
                                                                    {".json", "application/json"},
                                                                    {".png", "image/png"},
                                                                    {".jpg", "image/jpeg"},
                                                                    {".jpeg", "image/jpeg"},
                                                                    {".webp", "image/webp"}};
    for (auto [end, type] : types)
        if (name.size() > std::string_view(end).size() && name.ends_with(end)) return type;
    return "application/octet-stream";
}

// A plain file name, without folders: the page has none, and nothing leads out of its folder.
bool is_plain(std::string_view name) {
    return !name.empty() && name[0] != '.' && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' ||
               c == '_';
    });
}

Response answer(const Request& request, http::status status, const char* type, std::string body) {
    Response response{status, request.version()};
    response.set(http::field::content_type, type);
    response.set(http::field::cache_control, "no-cache");
    response.set("X-Content-Type-Options", "nosniff");
    response.set(http::field::x_frame_options, "DENY");
    // Isolated from other pages: the engine in the page may share memory between threads.
    response.set("Cross-Origin-Opener-Policy", "same-origin");
    response.set("Cross-Origin-Embedder-Policy", "require-corp");
    response.keep_alive(request.keep_alive());
    response.body() = std::move(body);
    response.prepare_payload();
    if (request.method() == http::verb::head) response.body().clear();
    return response;
}

Response page(const Request& request, const Shared& shared) {
    auto plain = [&](http::status status, const char* words) {
        return answer(request, status, "text/plain; charset=utf-8", words);
    };
    if (!is_ours(request[http::field::host], shared.port))
        return plain(http::status::forbidden, "This server answers to localhost alone.\n");
    if (request.method() != http::verb::get && request.method() != http::verb::head)
        return plain(http::status::method_not_allowed, "GET and HEAD only.\n");
    std::string target(request.target());
    target = target.substr(0, target.find('?'));
    std::string name = target == "/" ? "index.html" : target.substr(std::min<size_t>(1, target.size()));
    if (name == "recording" && !shared.options.recording.empty())
        return answer(request, http::status::ok, "application/octet-stream", shared.options.recording);
    const auto known = shared.options.files.find(name);
    const bool given = known != shared.options.files.end();
    const std::string path = given ? known->second : shared.options.folder + "/" + name;
    std::error_code error;
    if (!(given || is_plain(name)) || !std::filesystem::is_regular_file(path, error))
        return plain(http::status::not_found, "There is no such file.\n");
    Result<std::string> bytes = read_file(path);
    if (!bytes.ok()) return plain(http::status::not_found, "There is no such file.\n");
    std::string body = std::move(bytes).value();
    const size_t head = name == "index.html" ? body.find("<head>") : std::string::npos;
    if (head != std::string::npos) body.insert(head + 6, shared.options.head);
    return answer(request, http::status::ok, type_of(name), std::move(body));
}

// A stream: waits for a request, answers it, waits for the next.
class Stream : public std::enable_shared_from_this<Stream> {
public:
    Stream(beast::tcp_stream&& socket, std::shared_ptr<Shared> shared)
        : socket_(std::move(socket)), counted_(shared), session_(shared->open) {}

    void run(Request request) {
        auto timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
        timeout.idle_timeout = 2 * patience;  // pings keep a page that only looks connected
        socket_.set_option(timeout);
        socket_.read_message_max(max_request_bytes);
        socket_.text(false);
        socket_.async_accept(request, [self = shared_from_this()](beast::error_code error) {
            if (!error) self->read();
        });
    }

private:
    void read() {
        socket_.async_read(buffer_, [self = shared_from_this()](beast::error_code error, size_t) {
            if (error) return;  // gone, too slow, or a message beyond the bound
            self->reply();
        });
    }
    void reply() {
        out_ =
            session_.answer(std::string_view(static_cast<const char*>(buffer_.cdata().data()), buffer_.cdata().size()));
        buffer_.consume(buffer_.size());
        socket_.binary(true);
        socket_.async_write(asio::buffer(out_), [self = shared_from_this()](beast::error_code error, size_t) {
            if (!error) self->read();
        });
    }

    websocket::stream<beast::tcp_stream> socket_;
    Counted counted_;
    Session session_;
    beast::flat_buffer buffer_;
    std::string out_;
};

// A connection for files, which may become a stream.
class Connection : public std::enable_shared_from_this<Connection> {
public:
    Connection(Tcp::socket&& socket, std::shared_ptr<Shared> shared)
        : socket_(std::move(socket)), shared_(shared), counted_(shared) {}

    void read() {
        parser_.emplace();
        parser_->body_limit(1024);
        parser_->header_limit(16 * 1024);
        socket_.expires_after(patience);
        http::async_read(socket_, buffer_, *parser_, [self = shared_from_this()](beast::error_code error, size_t) {
            if (!error) self->handle(self->parser_->release());
        });
    }

private:
    void handle(Request request) {
        if (!websocket::is_upgrade(request)) return write(page(request, *shared_));
        const bool ours = is_ours(request[http::field::host], shared_->port) && is_own_page(request, shared_->port);
        if (!ours || request.target() != "/stream")
            return write(
                answer(request, http::status::forbidden, "text/plain", "Streams are for this server's page.\n"));
        shared_->ever_connected = true;
        socket_.expires_never();
        std::make_shared<Stream>(std::move(socket_), shared_)->run(std::move(request));
    }
    void write(Response response) {
        shared_->ever_connected = true;
        response_ = std::move(response);
        socket_.expires_after(patience);
        http::async_write(socket_, response_, [self = shared_from_this()](beast::error_code error, size_t) {
            if (!error && self->response_.keep_alive()) self->read();
        });
    }

    beast::tcp_stream socket_;
    std::shared_ptr<Shared> shared_;
    Counted counted_;
    beast::flat_buffer buffer_;
    std::optional<http::request_parser<http::string_body>> parser_;
    Response response_;
};

void accept(Tcp::acceptor& acceptor, const std::shared_ptr<Shared>& shared) {
    acceptor.async_accept([&acceptor, shared](beast::error_code error, Tcp::socket socket) {
        if (error == asio::error::operation_aborted) return;
        if (!error && shared->connections < most_connections)
            std::make_shared<Connection>(std::move(socket), shared)->read();
        accept(acceptor, shared);
    });
}

// Ends the loop once nobody has been connected for that long.
void watch(asio::steady_timer& timer, asio::io_context& loop, const std::shared_ptr<Shared>& shared) {
    timer.expires_after(
        std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::duration<double>(shared->options.give_up)));
    timer.async_wait([&timer, &loop, shared](beast::error_code error) {
        if (error) return;
        if (shared->connections == 0 && !shared->ever_connected) return loop.stop();
        shared->ever_connected = false;
        watch(timer, loop, shared);
    });
}

beast::error_code listen(Tcp::acceptor& acceptor, uint16_t port) {
    beast::error_code error;
    const Tcp::endpoint here(asio::ip::address_v4::loopback(), port);
    acceptor.open(here.protocol(), error);
    if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) acceptor.bind(here, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (error) acceptor.close();
    return error;
}

}  // namespace

Status serve(const ServerOptions& options, const OpenScene& open, const std::function<void(uint16_t port)>& ready) {
    asio::io_context loop(1);
    Tcp::acceptor acceptor(loop);
    beast::error_code error = listen(acceptor, options.port);
    if (error && options.any_port) error = listen(acceptor, 0);
    if (error)
        return Error{ErrorCode::io, "port " + std::to_string(options.port) + ": " + error.message() +
                                        "; another one may be given by --port"};
    auto shared = std::make_shared<Shared>(Shared{options, open, acceptor.local_endpoint().port()});
    asio::signal_set signals(loop, SIGINT, SIGTERM);
    signals.async_wait([&loop](beast::error_code, int) { loop.stop(); });
    asio::steady_timer timer(loop);
    if (options.give_up > 0.0) watch(timer, loop, shared);
    accept(acceptor, shared);
    ready(shared->port);
    loop.run();
    return {};
}

}  // namespace lendulet::cli
