// SPDX-License-Identifier: MIT
#include "scenes/json.h"

#include <iterator>
#include <nlohmann/json.hpp>

#include <samestep/scene.h>

namespace samestep::json {
namespace {

/// Position of the reader. nlohmann's events carry no place, so the iterator it reads through keeps it.
struct Position {
  std::uint32_t line = 1;
  bool endsLine = false;  ///< The character read last ended a line.
};

class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, Position* position) : at_(at), position_(position) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    position_->endsLine = *at_ == '\n';
    if (position_->endsLine) ++position_->line;
    ++at_;
    return *this;
  }
  CountingIterator operator++(int) {
    CountingIterator before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const CountingIterator& a, const CountingIterator& b) { return a.at_ == b.at_; }

 private:
  const char* at_;
  Position* position_;
};

/// No object of a scene has that many; keys are searched one by one.
constexpr std::size_t kMaxKeys = 64;

/// Builds the nodes from nlohmann's events.
class Builder {
 public:
  Builder(const std::string& file, const Position& position) : file_(file), position_(position) {}

  bool null() { return put(make(Kind::null, position_.line)); }
  bool boolean(bool value) {
    Node node = make(Kind::boolean, position_.line);
    node.truth = value;
    return put(std::move(node));
  }
  bool number_integer(std::int64_t value) { return number(std::to_string(value)); }
  bool number_unsigned(std::uint64_t value) { return number(std::to_string(value)); }
  bool number_float(double, const std::string& text) { return number(text); }
  bool string(std::string& value) {
    Node node = make(Kind::string, position_.line);
    node.text = std::move(value);
    return put(std::move(node));
  }
  bool binary(nlohmann::json::binary_t&) { return false; }
  bool start_object(std::size_t) { return open(Kind::object); }
  bool start_array(std::size_t) { return open(Kind::array); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(std::string& name) {
    Node& object = open_.back();
    if (object.keys.size() == kMaxKeys) throw SceneError(file_, position_.line, "", "too many keys");
    if (object.find(name) != nullptr) {
      throw SceneError(file_, position_.line, "", "the key \"" + name + "\" stands twice");
    }
    object.keys.push_back(std::move(name));
    return true;
  }
  bool parse_error(std::size_t, const std::string& token, const nlohmann::detail::exception& error) {
    constexpr int kNumberOverflow = 406;
    if (error.id == kNumberOverflow)
      throw SceneError(file_, position_.line, "", "too large a number: " + token);
    throw SceneError(file_, position_.line, "", "not JSON at \"" + token + "\"");
  }

  Node result() { return std::move(root_); }

 private:
  Node make(Kind kind, std::uint32_t line) {
    if (++values_ > kMaxValues) {
      throw SceneError(file_, line, "", "more than " + std::to_string(kMaxValues) + " values");
    }
    Node node;
    node.kind = kind;
    node.line = line;
    return node;
  }
  bool number(std::string text) {
    // A number ends where another character begins, which has been read.
    Node node = make(Kind::number, position_.line - (position_.endsLine ? 1 : 0));
    node.text = std::move(text);
    return put(std::move(node));
  }
  bool open(Kind kind) {
    if (open_.size() == kMaxDepth) {
      throw SceneError(file_, position_.line, "", "nested deeper than " + std::to_string(kMaxDepth));
    }
    open_.push_back(make(kind, position_.line));
    return true;
  }
  bool close() {
    Node done = std::move(open_.back());
    open_.pop_back();
    return put(std::move(done));
  }
  bool put(Node node) {
    (open_.empty() ? root_ : open_.back().children.emplace_back()) = std::move(node);
    return true;
  }

  const std::string& file_;
  const Position& position_;
  std::uint32_t values_ = 0;
  std::vector<Node> open_;
  Node root_;
};

}  // namespace

const Node* Node::find(std::string_view key) const {
  for (std::size_t i = 0; i < keys.size() && i < children.size(); ++i) {
    if (keys[i] == key) return &children[i];
  }
  return nullptr;
}

Node parse(std::string_view text, const std::string& file) {
  Position position;
  Builder builder(file, position);
  const CountingIterator begin(text.data(), &position);
  const CountingIterator end(text.data() + text.size(), &position);
  nlohmann::json::sax_parse(begin, end, &builder);
  return builder.result();
}

}  // namespace samestep::json
