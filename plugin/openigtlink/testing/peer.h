#pragma once

/// Shared by tests of the wire: another program as a peer, and a plain connection.

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "plugin/openigtlink/bytes.h"

namespace palpate::plugin::igtl::testing {

inline sockaddr_in local(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// A port of this machine on which no program listens.
inline int free_port() {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = local(0);
  socklen_t size = sizeof(address);
  const bool named = ::bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0 &&
                     ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  ::close(socket);
  if (!named) throw std::runtime_error("no free port");
  return ntohs(address.sin_port);
}

/// A program that runs until it ends itself or gets SIGTERM. Its output goes to a file.
class Program {
 public:
  Program(const std::string& program, const std::string& arguments, const std::filesystem::path& output = "/dev/null") {
    std::vector<std::string> words{program};
    std::istringstream stream(arguments);
    for (std::string word; stream >> word;) words.push_back(word);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    child_ = ::fork();
    if (child_ == 0) {
      const int file = ::open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);  // NOLINT: a system call's own form
      ::dup2(file, STDOUT_FILENO);
      ::dup2(file, STDERR_FILENO);
      ::execv(argv.front(), argv.data());
      ::_exit(127);
    }
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program() { end(); }

  /// Returns its exit code; -1 if it was ended by a signal.
  int end(int signal = SIGTERM) {
    if (child_ > 0) ::kill(child_, signal);
    return wait();
  }
  int wait() {
    if (child_ <= 0) return exit_;
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = -1;
    return exit_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  /// Processor time of all its threads so far, ended ones included, s. It must be running.
  double processor_s() const {
    std::ifstream file("/proc/" + std::to_string(child_) + "/stat");
    std::string text((std::istreambuf_iterator<char>(file)), {});
    std::istringstream fields(text.substr(text.rfind(')') + 1));  // proc(5): a name in parentheses is the second field
    std::vector<std::string> words{std::istream_iterator<std::string>(fields), {}};
    return (std::stod(words.at(11)) + std::stod(words.at(12))) / static_cast<double>(::sysconf(_SC_CLK_TCK));
  }

 private:
  pid_t child_ = -1;
  int exit_ = -1;
};

class Connection {
 public:
  /// Waits up to ten seconds for the server.
  explicit Connection(int port) {
    const sockaddr_in address = local(port);
    for (int tries = 0; tries < 500; ++tries) {
      socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
      if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) return;
      ::close(socket_);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    throw std::runtime_error("nothing listens on the port");
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() { ::close(socket_); }

  int socket() const { return socket_; }
  /// False if the other side has closed it.
  bool send(ByteView bytes) {
    while (!bytes.empty()) {
      const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (count <= 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
    return true;
  }
  /// The bytes received within the time; empty if there are none.
  Bytes receive(int milliseconds = 100) {
    pollfd waiting{.fd = socket_, .events = POLLIN, .revents = 0};
    if (::poll(&waiting, 1, milliseconds) <= 0) return {};
    Bytes bytes(65536);
    const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
    closed_ = count <= 0;
    bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return bytes;
  }
  bool closed() const { return closed_; }

 private:
  int socket_ = -1;
  bool closed_ = false;
};

}  // namespace palpate::plugin::igtl::testing
