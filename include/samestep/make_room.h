// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace samestep {

/// Makes sure that a list can have so many elements without taking memory: at least twice as many as it had
/// room for, so that what is added one by one is moved a few times only. Where there is no memory, nothing
/// has changed.
template <class T>
void makeRoom(std::vector<T>& list, std::size_t elements) {
  const std::size_t room = list.capacity();
  if (elements > room) list.reserve(elements > 2 * room ? elements : 2 * room);
}

/// Makes room in lists of one length.
template <class... Lists>
void makeRoomForEach(std::size_t elements, Lists&... lists) {
  (makeRoom(lists, elements), ...);
}

}  // namespace samestep
