// SPDX-License-Identifier: MIT
// The arena in a window, against bots in this program or against others over the network.
//
//   arena [--players N]                          you against bots, over a simulated network
//   arena --seat 0 --port 4000 --word SECRET --peer 1=192.0.2.7:4000 [--peer 2=...]
//                                                over UDP: who knows the word may play, and read along
//   --bot          the own player is a bot as well
//   --frames N     ends after N frames
//   --picture F    writes the last frame as BMP
// Arrow keys push, the space bar pushes harder, C drops a crate.
#include <SDL2/SDL.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <samestep/circle_shape.h>
#include <samestep/fixed_math.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>
#include <samestep/space_game.h>

#include "arena/arena.h"
#include "netsim/network.h"
#ifdef SAMESTEP_TRANSPORT
#include <samestep/sealed_transport.h>
#include <samestep/udp_transport.h>
#endif

namespace {

using namespace samestep;
using Vec = Vector<Fixed>;

constexpr std::uint32_t kCrates = 20;
constexpr int kPixels = 720;
constexpr std::uint64_t kFrame = 16'667;

struct Options {
  std::uint32_t players = 2;
  Seat seat = 0;
  std::uint16_t port = 0;
  std::string word;
  std::array<std::string, kMaxPlayers> peers;
  bool remote = false;
  bool bot = false;
  std::uint32_t frames = 0;
  std::string picture;
};

void readPeer(Options& options, const std::string& text) {
  const auto equals = text.find('=');
  const int seat = std::atoi(text.c_str());
  if (equals == std::string::npos || seat < 0 || seat >= kMaxPlayers) {
    throw std::runtime_error("--peer is SEAT=HOST:PORT, not '" + text + "'");
  }
  options.peers[static_cast<std::size_t>(seat)] = text.substr(equals + 1);
  options.remote = true;
}

Options read(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--bot") {
      options.bot = true;
      continue;
    }
    if (i + 1 == argc) throw std::runtime_error(name + ": unknown, or lacks its value");
    const std::string value = argv[++i];
    if (name == "--players") {
      options.players = static_cast<std::uint32_t>(std::clamp(std::atoi(value.c_str()), 2, 4));
    } else if (name == "--seat") {
      options.seat = static_cast<Seat>(std::clamp(std::atoi(value.c_str()), 0, kMaxPlayers - 1));
    } else if (name == "--port") {
      options.port = static_cast<std::uint16_t>(std::atoi(value.c_str()));
    } else if (name == "--word") {
      options.word = value;
    } else if (name == "--peer") {
      readPeer(options, value);
    } else if (name == "--frames") {
      options.frames = static_cast<std::uint32_t>(std::atoi(value.c_str()));
    } else if (name == "--picture") {
      options.picture = value;
    } else {
      throw std::runtime_error(name + ": unknown");
    }
  }
  return options;
}

/// A game, and the session that keeps it the same as the others'.
struct Peer {
  Peer(SessionSettings settings, const Transport& transport)
      : arena(settings.players, kCrates),
        game(arena.space(), ratio<Fixed>(1, 60), arena::Arena<Fixed>::applyInputs, &arena),
        session((game.describe(settings), settings), game.functions(), transport) {}

  arena::Arena<Fixed> arena;
  SpaceGame<Fixed> game;
  Session session;
};

SessionSettings settingsOf(const Options& options, Seat seat) {
  SessionSettings settings;
  settings.players = static_cast<std::uint8_t>(options.players);
  settings.localSeat = seat;
  settings.maxHeldBytes = 1;
  settings.maxCommandBytes = 1;
  for (Seat other = 0; other < options.players; ++other) settings.addresses[other] = other;
  return settings;
}

/// Table by which the own peer reaches the others.
class Table {
 public:
  virtual ~Table() = default;
  virtual Peer& own() = 0;
  /// Acts before each frame; lets bots play.
  virtual void update(std::uint64_t now) = 0;
};

/// All peers in this program; those of the others are bots.
class LocalTable : public Table {
 public:
  explicit LocalTable(const Options& options) : own_(options.seat), network_(options.players, 1) {
    for (Seat seat = 0; seat < options.players; ++seat) {
      for (Address to = 0; to < options.players; ++to) {
        network_.profile(seat, to).delay = 40'000;
        network_.profile(seat, to).jitter = 10'000;
        network_.profile(seat, to).loss = 20;
      }
      ends_.push_back(std::make_unique<End>(End{this, seat}));
      peers_.push_back(std::make_unique<Peer>(settingsOf(options, seat), transport(*ends_.back())));
    }
  }
  Peer& own() override { return *peers_[own_]; }
  void update(std::uint64_t now) override {
    now_ = now;
    network_.deliver(now);
    for (Seat seat = 0; seat < peers_.size(); ++seat) {
      if (seat == own_) continue;
      Session& session = peers_[seat]->session;
      const std::uint8_t held = arena::botButtons(7, seat, session.tick());
      session.frame(now, {&held, 1});
    }
  }

 private:
  struct End {
    LocalTable* table;
    Seat seat;
  };
  static Transport transport(End& end) {
    return {&end,
            [](Address to, std::span<const std::uint8_t> bytes, void* data) {
              const End& from = *static_cast<End*>(data);
              from.table->network_.send(from.seat, to, bytes, from.table->now_);
            },
            [](Address& from, std::span<std::uint8_t> into, void* data) -> std::uint32_t {
              const End& to = *static_cast<End*>(data);
              auto& box = to.table->network_.inbox(to.seat);
              if (box.empty()) return 0;
              const auto size = static_cast<std::uint32_t>(box.front().bytes.size());
              std::memcpy(into.data(), box.front().bytes.data(), size);
              from = box.front().from;
              box.pop_front();
              return size;
            }};
  }

  Seat own_;
  netsim::Network network_;
  std::uint64_t now_ = 0;
  std::vector<std::unique_ptr<End>> ends_;
  std::vector<std::unique_ptr<Peer>> peers_;
};

#ifdef SAMESTEP_TRANSPORT

/// The word, cut to fit, as a secret; the last byte tells secrets of the same word apart.
std::array<std::uint8_t, 32> secretOf(const std::string& word, std::uint8_t last) {
  std::array<std::uint8_t, 32> secret{};
  std::copy_n(word.begin(), std::min<std::size_t>(word.size(), 31), secret.begin());
  secret[31] = last;
  return secret;
}

/// The others are elsewhere.
class RemoteTable : public Table {
 public:
  explicit RemoteTable(const Options& options)
      : udp_("0.0.0.0", options.port),
        sealed_(udp_.transport(), KeyPair::fromSeed(secretOf(options.word, options.seat)),
                {secretOf(options.word, 255)}) {
    SessionSettings settings = settingsOf(options, options.seat);
    settings.players = 1;
    for (Seat seat = 0; seat < kMaxPlayers; ++seat) {
      const std::string& text = options.peers[seat];
      if (text.empty()) continue;
      ++settings.players;
      const auto colon = text.rfind(':');
      const int port = colon == std::string::npos ? 0 : std::atoi(text.c_str() + colon + 1);
      const Address below = UdpTransport::address(text.substr(0, colon), static_cast<std::uint16_t>(port));
      if (below == 0 || port == 0) throw std::runtime_error("'" + text + "' is no IPv4 address with a port");
      settings.addresses[seat] =
          sealed_.addPeer(KeyPair::fromSeed(secretOf(options.word, seat)).publicKey, below);
    }
    peer_ = std::make_unique<Peer>(settings, sealed_.transport());
  }
  Peer& own() override { return *peer_; }
  void update(std::uint64_t now) override { sealed_.update(now); }

 private:
  UdpTransport udp_;
  SealedTransport sealed_;
  std::unique_ptr<Peer> peer_;
};

#endif

std::unique_ptr<Table> tableOf(const Options& options) {
  if (!options.remote) return std::make_unique<LocalTable>(options);
#ifdef SAMESTEP_TRANSPORT
  return std::make_unique<RemoteTable>(options);
#else
  throw std::runtime_error("this build has no network: libsodium was missing");
#endif
}

/// Draws worlds into a window.
class Window {
 public:
  Window() {
    if (SDL_Init(SDL_INIT_VIDEO) != 0) throw std::runtime_error(SDL_GetError());
    window_ = SDL_CreateWindow("Samestep arena", SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED, kPixels,
                               kPixels, 0);
    if (window_ != nullptr) renderer_ = SDL_CreateRenderer(window_, -1, SDL_RENDERER_SOFTWARE);
    if (renderer_ == nullptr) throw std::runtime_error(SDL_GetError());
  }
  ~Window() {
    SDL_DestroyRenderer(renderer_);
    SDL_DestroyWindow(window_);
    SDL_Quit();
  }
  Window(const Window&) = delete;

  void draw(const Peer& peer) {
    scale_ = static_cast<float>(kPixels) / static_cast<float>(2 * peer.arena.size() + 2);
    SDL_SetRenderDrawColor(renderer_, 24, 26, 32, 255);
    SDL_RenderClear(renderer_);
    const Space<Fixed>& space = peer.arena.space();
    space.eachShape([&](const Shape<Fixed>& shape) { drawShape(peer, space.body(shape.body()), shape); });
  }
  void title(const Session& session) {
    const std::string text = "Samestep arena: tick " + std::to_string(session.tick()) + ", " +
                             std::to_string(session.stats().rollbacks) + " rollbacks";
    SDL_SetWindowTitle(window_, text.c_str());
  }
  void show() { SDL_RenderPresent(renderer_); }
  void save(const std::string& file) {
    SDL_Surface* surface = SDL_CreateRGBSurfaceWithFormat(0, kPixels, kPixels, 32, SDL_PIXELFORMAT_ARGB8888);
    const bool good = surface != nullptr &&
                      SDL_RenderReadPixels(renderer_, nullptr, SDL_PIXELFORMAT_ARGB8888, surface->pixels,
                                           surface->pitch) == 0 &&
                      SDL_SaveBMP(surface, file.c_str()) == 0;
    SDL_FreeSurface(surface);
    if (!good) throw std::runtime_error(file + ": " + SDL_GetError());
  }

 private:
  void drawShape(const Peer& peer, const Body<Fixed>& body, const Shape<Fixed>& shape) {
    std::vector<Vec> points;
    if (shape.type() == ShapeType::circle) {
      const ConstCircleShape<Fixed> circle(shape);
      // Twelve corners, and a spoke that shows how it turns.
      for (int i = 0; i <= 12; ++i) {
        points.push_back(circle.offset() + rotated(ratio<Fixed>(i * 6283, 12'000)) * circle.radius());
      }
      points.push_back(circle.offset());
    } else if (shape.type() == ShapeType::segment) {
      const ConstSegmentShape<Fixed> segment(shape);
      points = {segment.a(), segment.b()};
    } else {
      const ConstPolyShape<Fixed> poly(shape);
      for (int i = 0; i <= poly.count(); ++i) points.push_back(poly.vertex(i % poly.count()));
    }
    colour(peer, shape.body());
    std::vector<SDL_FPoint> line;
    for (const Vec& point : points) line.push_back(onScreen(body.toWorld(point)));
    SDL_RenderDrawLinesF(renderer_, line.data(), static_cast<int>(line.size()));
  }
  static Vec rotated(Fixed angle) {
    const SinCos<Fixed> way = sincos(angle);
    return {way.cos, way.sin};
  }
  void colour(const Peer& peer, BodyId body) {
    constexpr SDL_Color kPlayers[] = {
        {255, 110, 90, 255}, {90, 170, 255, 255}, {120, 220, 120, 255}, {250, 210, 80, 255}};
    SDL_Color chosen{150, 150, 160, 255};
    for (Seat seat = 0; seat < 4; ++seat) {
      if (peer.arena.player(seat) == body && body.valid()) chosen = kPlayers[seat];
    }
    SDL_SetRenderDrawColor(renderer_, chosen.r, chosen.g, chosen.b, chosen.a);
  }
  SDL_FPoint onScreen(const Vec& at) const {
    constexpr float kHalf = kPixels / 2.0f;
    return {kHalf + static_cast<float>(static_cast<double>(at.x)) * scale_,
            kHalf - static_cast<float>(static_cast<double>(at.y)) * scale_};
  }

  SDL_Window* window_ = nullptr;
  SDL_Renderer* renderer_ = nullptr;
  float scale_ = 1;
};

std::uint8_t heldKeys() {
  const std::uint8_t* keys = SDL_GetKeyboardState(nullptr);
  const auto held = [&](SDL_Scancode key, std::uint8_t button) { return keys[key] != 0 ? button : 0; };
  return static_cast<std::uint8_t>(held(SDL_SCANCODE_LEFT, arena::kLeft) |
                                   held(SDL_SCANCODE_RIGHT, arena::kRight) |
                                   held(SDL_SCANCODE_UP, arena::kUp) | held(SDL_SCANCODE_DOWN, arena::kDown) |
                                   held(SDL_SCANCODE_SPACE, arena::kDash));
}

/// @return false where the window was closed
bool takeEvents(Session& session) {
  for (SDL_Event event; SDL_PollEvent(&event) != 0;) {
    if (event.type == SDL_QUIT) return false;
    if (event.type == SDL_KEYDOWN && event.key.keysym.scancode == SDL_SCANCODE_C) {
      session.command({&arena::kDropCrate, 1});
    }
  }
  for (SessionEvent event; session.next(event);) {
    if (event.kind == SessionEvent::Kind::desync) std::printf("desync at tick %u\n", event.tick);
    if (event.kind == SessionEvent::Kind::dropped) std::printf("player %u was dropped\n", event.seat);
  }
  return session.state() != SessionState::ended;
}

void play(const Options& options) {
  const std::unique_ptr<Table> table = tableOf(options);
  Window window;
  Session& session = table->own().session;
  std::uint64_t next = 0;
  std::uint32_t frames = 0;
  while (takeEvents(session) && (options.frames == 0 || frames < options.frames)) {
    const std::uint64_t now = SDL_GetTicks64() * 1000;
    if (now < next) {
      SDL_Delay(1);
      continue;
    }
    next = std::max(next + kFrame * session.frameLength() / 1000, now > kFrame ? now - kFrame : 0);
    table->update(now);
    const std::uint8_t held = options.bot ? arena::botButtons(7, options.seat, session.tick()) : heldKeys();
    session.frame(now, {&held, 1});
    window.draw(table->own());
    window.title(session);
    if (++frames == options.frames && !options.picture.empty()) window.save(options.picture);
    window.show();
  }
  std::printf("%u ticks, %llu rollbacks\n", session.tick(),
              static_cast<unsigned long long>(session.stats().rollbacks));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    play(read(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "arena: %s\n", error.what());
    return 1;
  }
  return 0;
}
