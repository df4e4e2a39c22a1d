// SPDX-License-Identifier: MIT
#include "cli/program.h"

#ifdef SAMESTEP_VIEW
#include <httplib.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>

extern char** environ;

namespace samestep::program {
namespace {

struct Options {
  std::vector<std::string> files;
  std::string folder;
  bool dontOpen = false;
};

/// The folder of the viewer: the given one, the installed one beside the program, or what scripts/web built.
/// @throws Unusable
std::string viewerFolder(const std::string& given) {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::string installed = (program.parent_path() / SAMESTEP_VIEWER_FROM_PROGRAM).string();
  const std::vector<std::string> places =
      given.empty() ? std::vector<std::string>{installed, SAMESTEP_VIEWER_BUILT} : std::vector{given};
  for (const std::string& place : places) {
    if (std::filesystem::is_regular_file(place + "/index.html", error)) return place;
  }
  throw Unusable(places.back() + ": there is no viewer; scripts/web builds it, --viewer names its folder");
}

/// Files by the names that the page asks for: without their folders, and with a number where two are alike.
/// @throws Unusable
std::map<std::string, std::string> readFiles(const std::vector<std::string>& paths) {
  std::map<std::string, std::string> files;
  for (const std::string& path : paths) {
    const bool scene = path.ends_with(".json");
    std::string bytes;
    if (scene) {
      std::ifstream stream(path, std::ios::binary);
      if (!stream) throw Unusable(path + ": cannot be read");
      bytes.assign(std::istreambuf_iterator<char>(stream), {});
    } else {
      const std::vector<std::uint8_t> recording = readRecording(path);
      bytes.assign(recording.begin(), recording.end());
    }
    std::string name = std::filesystem::path(path).filename().string();
    if (files.count(name) != 0) name = std::to_string(files.size() + 1) + "-" + name;
    files.emplace(name, std::move(bytes));
  }
  return files;
}

/// Opens the desktop's browser, where there is one.
void openInBrowser(std::string address) {
  std::string opener = "xdg-open";
  char* arguments[] = {opener.data(), address.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, opener.c_str(), nullptr, nullptr, arguments, environ) == 0)
    waitpid(child, nullptr, 0);
}

std::string encoded(const std::string& name) {
  static const char* const digits = "0123456789ABCDEF";
  std::string text;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (byte >= '0' && byte <= '9') || (byte >= 'a' && byte <= 'z') ||
                       (byte >= 'A' && byte <= 'Z') || byte == '-' || byte == '.' || byte == '_';
    text += plain ? std::string(1, c) : std::string{'%', digits[byte >> 4], digits[byte & 15]};
  }
  return text;
}

/// Serves the viewer and the files to this machine alone, until it is interrupted.
int view(const Options& options) {
  const std::string folder = viewerFolder(options.folder);
  const std::map<std::string, std::string> files = readFiles(options.files);
  httplib::Server server;
  const int port = server.bind_to_any_port("127.0.0.1");
  if (port <= 0) throw Unusable("no port of 127.0.0.1 can be had");
  const std::string host = "127.0.0.1:" + std::to_string(port);
  server.set_file_extension_and_mimetype_mapping("wasm", "application/wasm");
  server.set_default_headers(
      {{"X-Content-Type-Options", "nosniff"}, {"Cross-Origin-Resource-Policy", "same-origin"}});
  // A page from elsewhere must not read the files by a name that leads here.
  server.set_pre_routing_handler([&host](const httplib::Request& request, httplib::Response& response) {
    if (request.get_header_value("Host") == host) return httplib::Server::HandlerResponse::Unhandled;
    response.status = 403;
    return httplib::Server::HandlerResponse::Handled;
  });
  server.Get("/recordings/(.+)", [&files](const httplib::Request& request, httplib::Response& response) {
    const auto found = files.find(request.matches[1].str());
    if (found == files.end()) {
      response.status = 404;
    } else {
      response.set_content(found->second, "application/octet-stream");
    }
  });
  server.set_mount_point("/", folder);
  std::string address = "http://" + host + "/";
  char before = '?';
  for (const auto& [name, bytes] : files) {
    address += before + ("file=" + encoded(name));
    before = '&';
  }
  std::printf("%s\nCtrl-C ends it.\n", address.c_str());
  std::fflush(stdout);
  if (!options.dontOpen) openInBrowser(address);
  return server.listen_after_bind() ? kGood : kUnusable;
}

}  // namespace

void addView(CLI::App& app, int& result) {
  CLI::App* word =
      app.add_subcommand("view", "Look at recordings or scenes in the browser; needs no network");
  auto options = std::make_shared<Options>();
  word->add_option("FILE", options->files, "Recordings or scenes: one, or two to be compared")
      ->expected(0, 2);
  word->add_option("--viewer", options->folder, "The folder of the viewer");
  word->add_flag("--no-open", options->dontOpen, "Only say the address");
  word->callback([options, &result] { result = view(*options); });
}

}  // namespace samestep::program

#else

namespace samestep::program {

void addView(CLI::App&, int&) {}

}  // namespace samestep::program

#endif
