// SPDX-License-Identifier: MIT
// HashSet, Array and SlotMap against simple models: the same contents in the order that is promised.
#include <samestep/array.h>
#include <samestep/hash_set.h>
#include <samestep/slot_map.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "check.h"
#include "input.h"

namespace samestep::fuzz {
namespace {

struct SameNumber {
  bool operator()(std::uint32_t key, std::uint32_t element) const { return key == element; }
};
using Set = HashSet<std::uint32_t, SameNumber>;
using Numbers = std::vector<std::uint32_t>;

/// Few hashes for many keys, so that buckets are shared and equal hashes are common.
HashValue hashOf(std::uint32_t key, std::uint64_t kind) {
  if (kind == 0) return key;
  if (kind == 1) return key % 3;
  return static_cast<HashValue>(key) << 32;
}

void checkSet(const Set& set, const Numbers& model) {
  expect(set.count() == model.size(), "the set counts its elements");
  std::size_t at = 0;
  set.each([&](std::uint32_t element) {
    expect(at < model.size() && model[at] == element, "the set visits in order of insertion");
    ++at;
  });
  expect(at == model.size(), "the set visits all its elements");
}

void runSet(Input& input, std::uint64_t head) {
  const std::uint64_t kind = byteOf(head, 1) % 3;
  Set set(byteOf(head, 2));
  set.setDefaultValue(0xffffffffu);
  Numbers model;
  while (!input.atEnd()) {
    const std::uint64_t op = input.word();
    const auto key = static_cast<std::uint32_t>(byteOf(op, 1)) | (byteOf(op, 3) % 4u) << 8;
    const HashValue hash = hashOf(key, kind);
    const auto found = std::find(model.begin(), model.end(), key);
    switch (op % 8) {
      case 0:
      case 1:
      case 2: {
        // A run of keys, so that the set grows.
        const std::uint32_t count = 1 + byteOf(op, 2) % 16u;
        for (std::uint32_t i = 0; i < count; ++i) {
          expect(set.insert(hashOf(key + i, kind), key + i) == key + i, "insert gives the element");
          if (std::find(model.begin(), model.end(), key + i) == model.end()) model.push_back(key + i);
        }
        break;
      }
      case 3: {
        const std::optional<std::uint32_t> removed = set.remove(hash, key);
        expect(removed.has_value() == (found != model.end()), "remove finds what is there");
        if (removed) {
          expect(*removed == key, "remove gives the element");
          model.erase(found);
        }
        break;
      }
      case 4:
        expect(set.find(hash, key) == (found != model.end() ? key : 0xffffffffu), "find or the default");
        expect((set.lookup(hash, key) != nullptr) == (found != model.end()), "lookup finds what is there");
        break;
      case 5: {
        const std::uint32_t divisor = 2 + byteOf(op, 2) % 5u;
        set.filter([&](std::uint32_t element) { return element % divisor != 0; });
        std::erase_if(model, [&](std::uint32_t element) { return element % divisor == 0; });
        break;
      }
      case 6: {
        Set copy(set);
        checkSet(copy, model);
        set = std::move(copy);
        break;
      }
      default:
        if (byteOf(op, 2) == 0) {
          set.clear();
          model.clear();
        }
        break;
    }
    checkSet(set, model);
  }
}

void runArray(Input& input, std::uint64_t head) {
  Array<std::uint32_t> array(byteOf(head, 1));
  Numbers model;
  while (!input.atEnd()) {
    const std::uint64_t op = input.word();
    const std::uint32_t item = byteOf(op, 1) % 32u;
    switch (op % 6) {
      case 0:
      case 1:
        array.push(item);
        model.push_back(item);
        break;
      case 2: {
        bool refused = false;
        std::uint32_t last = 0;
        try {
          last = array.pop();
        } catch (const IndexOutOfBounds&) {
          refused = true;
        }
        expect(refused == model.empty(), "pop refuses an empty array only");
        if (!refused) {
          expect(last == model.back(), "pop gives the last");
          model.pop_back();
        }
        break;
      }
      case 3: {
        const auto found = std::find(model.begin(), model.end(), item);
        expect(array.deleteObj(item) == (found != model.end()), "deleteObj finds what is there");
        if (found != model.end()) {
          *found = model.back();
          model.pop_back();
        }
        break;
      }
      case 4: {
        bool refused = false;
        try {
          const std::uint32_t value = array[item];
          expect(item < model.size() && value == model[item], "an index gives its element");
        } catch (const IndexOutOfBounds&) {
          refused = true;
        }
        expect(refused == (item >= model.size()), "an index outside is refused");
        break;
      }
      default: {
        expect(array.contains(item) == (std::find(model.begin(), model.end(), item) != model.end()),
               "contains tells what is there");
        if (byteOf(op, 2) != 0) break;
        std::size_t released = 0;
        array.clear([&](std::uint32_t) { ++released; });
        expect(released == model.size(), "clear releases each");
        model.clear();
        break;
      }
    }
    expect(std::equal(array.begin(), array.end(), model.begin(), model.end()), "the array is its model");
  }
}

struct Tag;
using TestId = Id<Tag>;
using Map = SlotMap<std::uint32_t, TestId>;

struct Entry {
  TestId id;
  std::uint32_t value;
};

void checkMap(const Map& map, const std::vector<Entry>& alive, const std::vector<TestId>& dead) {
  expect(map.size() == alive.size(), "the map counts its values");
  for (const Entry& entry : alive) {
    expect(map.contains(entry.id) && *map.find(entry.id) == entry.value, "an id names its value");
  }
  for (const TestId id : dead) expect(!map.contains(id), "the id of an erased value names nothing");
  std::uint32_t last = 0;
  std::size_t visited = 0;
  map.each([&](TestId id, std::uint32_t) {
    expect(visited == 0 || id.index > last, "values are visited by rising index");
    last = id.index;
    ++visited;
  });
  expect(visited == alive.size(), "all values are visited");
}

void runMap(Input& input) {
  Map map;
  std::vector<Entry> alive;
  std::vector<TestId> dead;
  while (!input.atEnd()) {
    const std::uint64_t op = input.word();
    const std::size_t at = alive.empty() ? 0 : byteOf(op, 1) % alive.size();
    switch (op % 6) {
      case 0:
      case 1: {
        const TestId promised = map.nextId();
        const auto value = static_cast<std::uint32_t>(op >> 16);
        const TestId id = map.insert(value);
        expect(id == promised, "insert gives the id that nextId said");
        alive.push_back({id, value});
        break;
      }
      case 2:
        if (alive.empty()) break;
        expect(map.erase(alive[at].id), "erase finds what is there");
        dead.push_back(alive[at].id);
        alive.erase(alive.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      case 3: {
        const TestId id{static_cast<std::uint32_t>(byteOf(op, 1)), byteOf(op, 2)};
        const bool known =
            std::any_of(alive.begin(), alive.end(), [&](const Entry& entry) { return entry.id == id; });
        if (!known) expect(!map.erase(id), "a made-up id erases nothing");
        expect((map.find(id) != nullptr) == known, "a made-up id finds nothing");
        break;
      }
      case 4: {
        Map other;
        expect(other.restore(map.values(), map.generations()), "a state that was is restored");
        expect(other == map && other.nextId() == map.nextId(), "a restored map is equal");
        map = std::move(other);
        break;
      }
      default: {
        // A state made up: restored or refused, never half.
        std::vector<std::uint32_t> generations;
        for (std::uint32_t i = 0; i < byteOf(op, 1) % 8u; ++i) generations.push_back(byteOf(op, 2) * (i + 1));
        Map other;
        if (!other.restore(Numbers(byteOf(op, 5) % 8u), generations)) {
          expect(other.size() == 0 && other.slots() == 0, "a refused state changes nothing");
        }
        break;
      }
    }
    checkMap(map, alive, dead);
  }
}

}  // namespace
}  // namespace samestep::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  samestep::fuzz::Input input(data, size);
  const std::uint64_t head = input.word();
  switch (head % 3) {
    case 0:
      samestep::fuzz::runSet(input, head);
      break;
    case 1:
      samestep::fuzz::runArray(input, head);
      break;
    default:
      samestep::fuzz::runMap(input);
      break;
  }
  return 0;
}
