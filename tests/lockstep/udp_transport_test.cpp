// SPDX-License-Identifier: MIT
#include <samestep/udp_transport.h>

#include <array>
#include <string>
#include <system_error>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace samestep {
namespace {

constexpr const char* kHere = "127.0.0.1";

/// The next datagram, waited for at most two seconds.
std::vector<std::uint8_t> next(UdpTransport& transport, Address& from, std::size_t room = kMaxDatagram) {
  std::vector<std::uint8_t> bytes(room);
  transport.wait(2000);
  bytes.resize(transport.receive(from, bytes));
  return bytes;
}

TEST(UdpTransportTest, ADatagramArrivesWithItsSender) {
  UdpTransport a(kHere), b(kHere);
  const std::array<std::uint8_t, 3> bytes{1, 2, 3};

  a.send(UdpTransport::address(kHere, b.port()), bytes);

  Address from = 0;
  EXPECT_THAT(next(b, from), testing::ElementsAre(1, 2, 3));
  EXPECT_EQ(from, UdpTransport::address(kHere, a.port()));
  EXPECT_EQ(UdpTransport::text(from), "127.0.0.1:" + std::to_string(a.port()));
}

TEST(UdpTransportTest, WhereNothingWaitsNothingIsReceived) {
  UdpTransport transport(kHere);
  std::array<std::uint8_t, 16> bytes;
  Address from = 0;

  EXPECT_EQ(transport.receive(from, bytes), 0u);
}

TEST(UdpTransportTest, ADatagramLongerThanTheRoomForItIsDroppedAndCounted) {
  UdpTransport a(kHere), b(kHere);
  a.send(UdpTransport::address(kHere, b.port()), std::vector<std::uint8_t>(20));
  Address from = 0;

  EXPECT_TRUE(next(b, from, 10).empty());
  EXPECT_EQ(b.tooLong(), 1u);
}

TEST(UdpTransportTest, APeerThatIsGoneStopsNothing) {
  UdpTransport a(kHere), b(kHere);
  Address gone = 0;
  {
    const UdpTransport c(kHere);
    gone = UdpTransport::address(kHere, c.port());
  }
  const std::array<std::uint8_t, 1> bytes{7};
  for (int i = 0; i < 3; ++i) a.send(gone, bytes);
  b.send(UdpTransport::address(kHere, a.port()), bytes);

  Address from = 0;
  EXPECT_THAT(next(a, from), testing::ElementsAre(7));
}

TEST(UdpTransportTest, AnAddressThatCannotBeListenedAtIsNamed) {
  const UdpTransport taken(kHere);
  const auto refusal = [](const std::string& host, std::uint16_t port) -> std::string {
    try {
      const UdpTransport transport(host, port);
    } catch (const std::system_error& error) {
      return error.what();
    }
    return "";
  };

  EXPECT_THAT(refusal(kHere, taken.port()),
              testing::HasSubstr("cannot listen at 127.0.0.1:" + std::to_string(taken.port())));
  EXPECT_THAT(refusal("no address", 0), testing::HasSubstr("cannot listen at no address:0"));
  EXPECT_EQ(UdpTransport::address("no address", 5), 0u);
}

}  // namespace
}  // namespace samestep
