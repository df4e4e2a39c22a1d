#pragma once

#include <istream>
#include <ostream>
#include <string>

#include "samestep/fixed_text.h"

namespace samestep {

/// Writes the shortest decimal that reads back the same.
template <FixedNumber S>
std::ostream& operator<<(std::ostream& out, S x) {
  return out << formatDecimal(x);
}

/// Reads one word; sets failbit where it is no decimal in range.
template <FixedNumber S>
std::istream& operator>>(std::istream& in, S& x) {
  std::string word;
  if (in >> word && parseDecimal(word, x) != DecimalStatus::ok) in.setstate(std::ios::failbit);
  return in;
}

}  // namespace samestep
