// SPDX-License-Identifier: MIT
#include <samestep/decimal.h>
#include <samestep/state_diff.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/require_ieee.h"
#include "state/state_hash.h"

namespace samestep {
namespace {

std::string hexBits(std::uint64_t bits) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text = "0x";
  for (int shift = 60; shift >= 0; shift -= 4) text += kDigits[(bits >> shift) & 15];
  return text;
}

struct Field {
  std::string name;
  std::string text;
  friend bool operator==(const Field&, const Field&) = default;
};

/// Lists the fields of a record with their values as text, nested ones by their path.
class FieldLister {
 public:
  template <class T>
  void operator()(const char* name, const T& value) {
    // A field visited again and again is a list.
    const std::string path = prefix_ + name;
    repeats_ = path == last_ ? repeats_ + 1 : 0;
    last_ = path;
    list(repeats_ > 0 ? path + "[" + std::to_string(repeats_) + "]" : path, value);
  }

  std::vector<Field> fields;

 private:
  void list(const std::string& name, std::uint64_t value) { fields.push_back({name, std::to_string(value)}); }
  void list(const std::string& name, std::int64_t value) { fields.push_back({name, std::to_string(value)}); }
  void list(const std::string& name, std::uint32_t value) { list(name, std::uint64_t{value}); }
  void list(const std::string& name, std::uint16_t value) { list(name, std::uint64_t{value}); }
  void list(const std::string& name, std::uint8_t value) { list(name, std::uint64_t{value}); }
  void list(const std::string& name, std::int32_t value) { list(name, std::int64_t{value}); }
  void list(const std::string& name, double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    fields.push_back({name, formatDecimal(value) + " (" + hexBits(bits) + ")"});
  }
  template <class Overflow>
  void list(const std::string& name, const BasicFixed<std::int64_t, 32, Overflow>& value) {
    fields.push_back(
        {name, formatDecimal(value) + " (" + hexBits(static_cast<std::uint64_t>(value.raw())) + ")"});
  }
  template <Scalar S>
  void list(const std::string& name, const Vector<S>& value) {
    list(name + ".x", value.x);
    list(name + ".y", value.y);
  }
  template <class Tag>
  void list(const std::string& name, const Id<Tag>& id) {
    fields.push_back(
        {name, id.valid() ? std::to_string(id.index) + " (generation " + std::to_string(id.generation) + ")"
                          : "none"});
  }
  template <class T>
  requires std::is_enum_v<T>
  void list(const std::string& name, T value) { list(name, static_cast<std::underlying_type_t<T>>(value)); }
  template <class T>
  requires requires(const T& t) {
    t.mantissa();
    t.exponent();
  }
  void list(const std::string& name, const T& value) {
    fields.push_back({name, std::to_string(value.mantissa()) + " * 2^" + std::to_string(value.exponent())});
  }
  template <class T>
  requires requires(const T& t, FieldLister& lister) { T::fields(t, lister); }
  void list(const std::string& name, const T& value) {
    const std::string outer = std::exchange(prefix_, name + ".");
    T::fields(value, *this);
    prefix_ = outer;
  }

  std::string prefix_;
  std::string last_;
  std::uint32_t repeats_ = 0;
};

template <class T>
std::vector<Field> fieldsOf(const T& record) {
  FieldLister lister;
  T::fields(record, lister);
  return std::move(lister.fields);
}

/// Collects differences until there are enough.
class Collector {
 public:
  explicit Collector(std::uint32_t most) : most_(most) {}

  bool full() const { return found.size() >= most_; }
  void add(const std::string& object, const std::string& field, const std::string& a, const std::string& b) {
    if (!full()) found.push_back({object, field, a, b});
  }
  void exists(const std::string& object, bool inA) {
    add(object, "exists", inA ? "yes" : "no", inA ? "no" : "yes");
  }
  /// name() is asked only for an object that differs: most are equal.
  template <class T, class Name>
  void compare(const T& a, const T& b, Name&& name) {
    if (full()) return;
    const std::vector<Field> fieldsA = fieldsOf(a);
    const std::vector<Field> fieldsB = fieldsOf(b);
    if (fieldsA == fieldsB) return;
    const std::string object = name();
    for (std::uint32_t i = 0; i < std::max(fieldsA.size(), fieldsB.size()); ++i) {
      const Field& either = i < fieldsA.size() ? fieldsA[i] : fieldsB[i];
      const std::string textA = i < fieldsA.size() ? fieldsA[i].text : "none";
      const std::string textB = i < fieldsB.size() ? fieldsB[i].text : "none";
      if (textA != textB) add(object, either.name, textA, textB);
    }
  }
  /// The slots of two maps, side by side.
  template <class Map, class Name>
  void compareSlots(const Map& a, const Map& b, Name&& name) {
    const auto generation = [](const Map& map, std::uint32_t i) {
      return i < map.slots() ? std::to_string(map.generationAt(i)) : "none";
    };
    for (std::uint32_t i = 0; i < std::max(a.slots(), b.slots()) && !full(); ++i) {
      const bool inA = i < a.slots() && a.aliveAt(i);
      const bool inB = i < b.slots() && b.aliveAt(i);
      if (inA != inB) {
        exists(name(inA ? a : b, i), inA);
      } else if (inA) {
        if (a.generationAt(i) != b.generationAt(i)) {
          add(name(a, i), "generation", generation(a, i), generation(b, i));
        }
        compare(a.valueAt(i), b.valueAt(i), [&] { return name(a, i); });
      } else if (generation(a, i) != generation(b, i)) {
        add(name(i < a.slots() ? a : b, i), "generation", generation(a, i), generation(b, i));
      }
    }
  }
  /// Two sorted lists, side by side.
  template <class T, class Less, class Name>
  void compareLists(const std::vector<T>& a, const std::vector<T>& b, Less&& less, Name&& name) {
    auto inA = a.begin();
    auto inB = b.begin();
    while ((inA != a.end() || inB != b.end()) && !full()) {
      if (inB == b.end() || (inA != a.end() && less(*inA, *inB))) {
        exists(name(*inA++), true);
      } else if (inA == a.end() || less(*inB, *inA)) {
        exists(name(*inB++), false);
      } else {
        compare(*inA, *inB, [&] { return name(*inA); });
        ++inA;
        ++inB;
      }
    }
  }

  std::vector<FieldDifference> found;

 private:
  std::uint32_t most_;
};

/// A single field of a world, as a record.
template <class T>
struct Single {
  const char* name;
  const T& value;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit(self.name, self.value);
  }
};

template <class T, class IdType>
std::string nameOf(const Section& section, const SlotMap<T, IdType>&, std::uint32_t slot) {
  return section.object + (" " + std::to_string(slot));
}
template <Scalar S>
std::string nameOf(const Section& section, const SlotMap<Shape<S>, ShapeId>& shapes, std::uint32_t slot) {
  const std::string shape = section.object + (" " + std::to_string(slot));
  return shapes.aliveAt(slot) ? shape + " of body " + std::to_string(shapes.valueAt(slot).body().index)
                              : shape;
}
template <Scalar S>
std::string nameOf(const Section& section, const Pair<S>& pair) {
  return section.object +
         (" of shapes " + std::to_string(pair.a.index) + " and " + std::to_string(pair.b.index));
}
std::string nameOf(const Section& section, const HandlerBinding& binding) {
  return section.object +
         (" of types " + std::to_string(binding.typeA) + " and " + std::to_string(binding.typeB));
}

/// Compares the fields and sections of two worlds, side by side.
class SectionDiff {
 public:
  explicit SectionDiff(std::uint32_t most) : all_(most) {}

  template <class T>
  void operator()(const char* name, const T& a, const T& b) {
    if constexpr (requires(FieldLister & lister) { T::fields(a, lister); }) {
      all_.compare(a, b, [&] { return name; });
    } else {
      all_.compare(Single<T>{name, a}, Single<T>{name, b}, [] { return "clock"; });
    }
  }
  template <class T, class IdType>
  void operator()(const Section& section, const SlotMap<T, IdType>& a, const SlotMap<T, IdType>& b) {
    all_.compareSlots(a, b, [&](const auto& map, std::uint32_t slot) { return nameOf(section, map, slot); });
  }
  template <class T>
  void operator()(const Section& section, const std::vector<T>& a, const std::vector<T>& b) {
    all_.compareLists(a, b, T::before, [&](const T& record) { return nameOf(section, record); });
  }
  std::vector<FieldDifference> found() { return std::move(all_.found); }

 private:
  Collector all_;
};

}  // namespace

template <Scalar S>
std::vector<FieldDifference> differences(const WorldState<S>& a, const WorldState<S>& b, std::uint32_t most) {
  SectionDiff diff(most);
  WorldState<S>::sections(diff, a, b);
  return diff.found();
}

namespace {

template <Scalar S>
struct Describer {
  template <class T>
  std::string operator()(const T& plain) const {
    std::string text;
    for (const Field& field : fieldsOf(plain))
      text += (text.empty() ? "" : ", ") + field.name + " " + field.text;
    return text;
  }
  std::string operator()(const Spawn<S>& spawn) const {
    std::string text = (*this)(spawn.body) + ", " + std::to_string(spawn.shapes.size()) + " shapes";
    for (const Shape<S>& shape : spawn.shapes) text += "; " + (*this)(shape);
    return text;
  }
  std::string operator()(const UserInput& input) const {
    constexpr std::size_t kMostShown = 64;
    std::string text = std::to_string(input.bytes.size()) + " bytes";
    for (std::size_t i = 0; i < std::min(input.bytes.size(), kMostShown); ++i) {
      text += (i == 0 ? ": " : " ") + hexBits(input.bytes[i]).substr(16);
    }
    if (input.bytes.size() <= kMostShown) return text;
    // All that differs may be in what follows.
    return text + " ..., all of them XXH3 " + hexBits(XXH3_64bits(input.bytes.data(), input.bytes.size()));
  }
};

}  // namespace

namespace {

/// Calls visit(object, field) for each value of a world, in the order of differences().
template <class Visit>
class ValueWalk {
 public:
  explicit ValueWalk(Visit visit) : visit_(visit) {}

  template <class T>
  void operator()(const char* name, const T& value) {
    if constexpr (requires(FieldLister & lister) { T::fields(value, lister); }) {
      record(name, value);
    } else {
      record("clock", Single<T>{name, value});
    }
  }
  template <class T, class IdType>
  void operator()(const Section& section, const SlotMap<T, IdType>& map) {
    for (std::uint32_t slot = 0; slot < map.slots(); ++slot) {
      const std::string object = nameOf(section, map, slot);
      visit_(object, Field{"generation", std::to_string(map.generationAt(slot))});
      if (map.aliveAt(slot)) record(object, map.valueAt(slot));
    }
  }
  template <class T>
  void operator()(const Section& section, const std::vector<T>& list) {
    for (const T& entry : list) record(nameOf(section, entry), entry);
  }

 private:
  template <class T>
  void record(const std::string& object, const T& value) {
    for (const Field& field : fieldsOf(value)) visit_(object, field);
  }

  Visit visit_;
};

template <Scalar S, class Visit>
void eachValue(const WorldState<S>& world, Visit&& visit) {
  ValueWalk<Visit&> walk(visit);
  WorldState<S>::sections(walk, world);
}

}  // namespace

template <Scalar S>
std::vector<std::uint64_t> valueHashes(const WorldState<S>& world) {
  std::vector<std::uint64_t> hashes;
  std::string line;
  eachValue(world, [&](const std::string& object, const Field& field) {
    line.assign(object).append("\n").append(field.name).append("\n").append(field.text);
    hashes.push_back(XXH3_64bits(line.data(), line.size()));
  });
  return hashes;
}

template <Scalar S>
std::vector<WorldValue> valuesOf(const WorldState<S>& world) {
  std::vector<WorldValue> values;
  eachValue(world, [&](const std::string& object, const Field& field) {
    values.push_back({object, field.name, field.text});
  });
  return values;
}

template <Scalar S>
WorldValue valueAt(const WorldState<S>& world, std::uint32_t index) {
  WorldValue found;
  std::uint32_t passed = 0;
  eachValue(world, [&](const std::string& object, const Field& field) {
    if (passed++ == index) found = {object, field.name, field.text};
  });
  return found;
}

template <Scalar S>
std::string describe(const Command<S>& command) {
  return std::string(commandName(kindOf(command))) + ": " + std::visit(Describer<S>(), command);
}

#define SAMESTEP_EACH_SCALAR                                                                       \
  template std::vector<FieldDifference> differences<S>(const WorldState<S>&, const WorldState<S>&, \
                                                       std::uint32_t);                             \
  template std::vector<std::uint64_t> valueHashes<S>(const WorldState<S>&);                        \
  template std::vector<WorldValue> valuesOf<S>(const WorldState<S>&);                              \
  template WorldValue valueAt<S>(const WorldState<S>&, std::uint32_t);                             \
  template std::string describe<S>(const Command<S>&);
#include <samestep/each_scalar.h>

}  // namespace samestep
