// SPDX-License-Identifier: Apache-2.0
#include "support/process/nginx.h"
#include "support/product_names.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace vitrine::test {
namespace {

constexpr const char* kProgram = "/usr/sbin/nginx";

// Binds the port before nginx starts. The port is then certainly free, and clients that connect
// early wait. nginx inherits the socket, as it would from an older nginx that it replaces.
int listening_socket(std::uint16_t& port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* any = reinterpret_cast<sockaddr*>(&address);
  if (::bind(socket, any, size) != 0 || ::listen(socket, 511) != 0 ||
      ::getsockname(socket, any, &size) != 0) {
    throw std::runtime_error("no free port for nginx");
  }
  port = ntohs(address.sin_port);
  return socket;
}

std::string configuration(const std::string& server, const std::string& http, std::uint16_t port) {
  std::ostringstream text;
  text << (::geteuid() == 0 ? "user root;\n" : "")
       << "daemon off;\nworker_processes 1;\npid nginx.pid;\nerror_log error.log;\n"
          "events { worker_connections 4096; }\nhttp {\n"
          "client_body_temp_path body; proxy_temp_path proxy; fastcgi_temp_path fastcgi;\n"
          "uwsgi_temp_path uwsgi; scgi_temp_path scgi;\n"
       << http << "\nserver {\nlisten 127.0.0.1:" << port << ";\n"
       << server << "\n}\n}\n";
  return text.str();
}

}  // namespace

Nginx::Nginx(const std::string& server, const std::string& http) {
  if (::access(kProgram, X_OK) != 0)
    throw std::runtime_error("nginx is missing; run deploy/setup test");
  const int socket = listening_socket(port_);
  std::ofstream(folder_.path() / "nginx.conf") << configuration(server, http, port_);
  const std::string prefix = folder_.path().string() + "/";
  const std::string inherited = "NGINX=" + std::to_string(socket) + ";";
  child_ = ::fork();
  if (child_ == 0) {
    std::array<std::string, 7> words = {kProgram,     "-p", prefix,     "-c",
                                        "nginx.conf", "-e", "error.log"};
    std::array<char*, 8> arguments{};
    for (std::size_t i = 0; i < words.size(); ++i)
      arguments[i] = words[i].data();
    std::array<char*, 2> environment{const_cast<char*>(inherited.c_str()), nullptr};
    ::execve(kProgram, arguments.data(), environment.data());
    ::_exit(127);
  }
  ::close(socket);
}

std::string Nginx::log(const std::string& name) const {
  std::ostringstream text;
  text << std::ifstream(folder_.path() / name).rdbuf();
  return text.str();
}

// Lets nginx shut down fast by itself. SIGKILL would leave its worker behind.
Nginx::~Nginx() {
  ::kill(child_, SIGTERM);
  ::waitpid(child_, nullptr, 0);
}

}  // namespace vitrine::test
