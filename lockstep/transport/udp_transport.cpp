// SPDX-License-Identifier: MIT
#include <samestep/udp_transport.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace samestep {

namespace {

// Room for what arrives while a game draws a frame: some thousand datagrams.
constexpr int kSocketBuffer = 1 << 20;

Address addressOf(const sockaddr_in& socket) {
  return Address{ntohl(socket.sin_addr.s_addr)} << 16 | ntohs(socket.sin_port);
}

sockaddr_in socketOf(Address address) {
  sockaddr_in out{};
  out.sin_family = AF_INET;
  out.sin_addr.s_addr = htonl(static_cast<std::uint32_t>(address >> 16));
  out.sin_port = htons(static_cast<std::uint16_t>(address));
  return out;
}

}  // namespace

UdpTransport::UdpTransport(const std::string& host, std::uint16_t port) {
  const Address wanted = address(host, port);
  const auto refuse = [&](int error) {
    if (socket_ >= 0) close(socket_);
    throw std::system_error(error, std::generic_category(),
                            "cannot listen at " + host + ":" + std::to_string(port));
  };
  if (wanted >> 16 == 0 && host != "0.0.0.0") refuse(EINVAL);
  socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket_ < 0) refuse(errno);
  setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &kSocketBuffer, sizeof(kSocketBuffer));
  setsockopt(socket_, SOL_SOCKET, SO_SNDBUF, &kSocketBuffer, sizeof(kSocketBuffer));
  sockaddr_in own = socketOf(wanted);
  socklen_t length = sizeof(own);
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof(own)) != 0) refuse(errno);
  if (getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &length) != 0) refuse(errno);
  port_ = ntohs(own.sin_port);
}

UdpTransport::~UdpTransport() { close(socket_); }

Address UdpTransport::address(const std::string& host, std::uint16_t port) {
  in_addr parsed{};
  if (inet_pton(AF_INET, host.c_str(), &parsed) != 1) return 0;
  return Address{ntohl(parsed.s_addr)} << 16 | port;
}

std::string UdpTransport::text(Address address) {
  char buffer[INET_ADDRSTRLEN] = {};
  const sockaddr_in socket = socketOf(address);
  inet_ntop(AF_INET, &socket.sin_addr, buffer, sizeof(buffer));
  return std::string(buffer) + ":" + std::to_string(static_cast<std::uint16_t>(address));
}

void UdpTransport::send(Address to, std::span<const std::uint8_t> bytes) {
  const sockaddr_in target = socketOf(to);
  const auto sent = sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&target),
                           sizeof(target));
  if (sent != static_cast<ssize_t>(bytes.size())) ++unsent_;
}

std::uint32_t UdpTransport::receive(Address& from, std::span<std::uint8_t> into) {
  while (true) {
    sockaddr_in source{};
    socklen_t length = sizeof(source);
    const ssize_t got =
        recvfrom(socket_, into.data(), into.size(), MSG_TRUNC, reinterpret_cast<sockaddr*>(&source), &length);
    // A refusal by a peer that is not there (any more) is told once and stands for no datagram.
    if (got < 0 && (errno == ECONNREFUSED || errno == EINTR)) continue;
    if (got < 0) return 0;
    if (static_cast<std::size_t>(got) > into.size()) {
      ++tooLong_;
      continue;
    }
    if (got == 0) continue;
    from = addressOf(source);
    return static_cast<std::uint32_t>(got);
  }
}

Transport UdpTransport::transport() {
  return {this,
          [](Address to, std::span<const std::uint8_t> bytes, void* data) {
            static_cast<UdpTransport*>(data)->send(to, bytes);
          },
          [](Address& from, std::span<std::uint8_t> into, void* data) {
            return static_cast<UdpTransport*>(data)->receive(from, into);
          }};
}

void UdpTransport::wait(std::uint32_t milliseconds) const {
  pollfd waiting{socket_, POLLIN, 0};
  poll(&waiting, 1, static_cast<int>(milliseconds));
}

}  // namespace samestep
