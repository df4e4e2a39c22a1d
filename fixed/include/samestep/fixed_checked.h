#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <initializer_list>

#include "samestep/raw_decimal.h"

namespace samestep {

/// The text of a report: room for a name and the longest decimals of all operands.
class OverflowText {
 public:
  const char* c_str() const { return characters_.data(); }
  void append(const char* text) {
    while (*text != '\0') append(*text++);
  }
  void append(const raw::DecimalText& text) {
    for (int i = 0; i < text.length; ++i) append(text.characters[static_cast<std::size_t>(i)]);
  }

 private:
  void append(char c) {
    if (length_ + 1 < characters_.size()) characters_[length_++] = c;
  }

  std::array<char, 1024> characters_{};
  std::uint32_t length_ = 0;
};

/// Report of a checked number: an overflow, a lost quotient or an argument outside the domain.
struct OverflowReport {
  static constexpr int kMaxOperands = 8;

  const char* operation = "";                         ///< name of the function, "multiply" for the operator *
  std::array<std::int64_t, kMaxOperands> operands{};  ///< raw, in the order of the call
  int operandCount = 0;
  int fractionBits = 0;  ///< of the operands

  /// "multiply(2147483647, 2)"
  OverflowText text() const {
    OverflowText result;
    result.append(operation);
    result.append("(");
    for (int i = 0; i < operandCount; ++i) {
      if (i > 0) result.append(", ");
      result.append(raw::formatDecimal(operands[static_cast<std::size_t>(i)], fractionBits));
    }
    result.append(")");
    return result;
  }
};

/// Exception of the default handler; what() names the operation and its operands.
class FixedOverflow : public std::exception {
 public:
  explicit FixedOverflow(const OverflowReport& report) : report_(report), text_(report.text()) {}

  const OverflowReport& report() const { return report_; }
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  OverflowReport report_;
  OverflowText text_;
};

/// Function that is told of each report. If it returns, the operation gives what the wrapping number gives.
using OverflowHandler = void (*)(const OverflowReport&);

/// Throws FixedOverflow; aborts where exceptions are off.
inline void throwOverflow(const OverflowReport& report) {
#if defined(__cpp_exceptions)
  throw FixedOverflow(report);
#else
  static_cast<void>(report);
  std::abort();
#endif
}

inline OverflowHandler& currentOverflowHandler() {
  static OverflowHandler handler = &throwOverflow;
  return handler;
}

/// Sets the handler of all checked numbers, for all threads; nullptr restores the default.
/// @return the handler before
inline OverflowHandler setOverflowHandler(OverflowHandler handler) {
  const OverflowHandler before = currentOverflowHandler();
  currentOverflowHandler() = handler != nullptr ? handler : &throwOverflow;
  return before;
}

/// Overflow policy of release builds: arithmetic wraps modulo 2^bits, quotients saturate, nothing is
/// reported.
struct Wrapping {
  static constexpr bool kChecks = false;
};

/// Overflow policy of tests: the same results, after a report to the handler.
struct Checked {
  static constexpr bool kChecks = true;
};

namespace raw {

/// Not constexpr: an overflow in a constant expression is a compile error for checked numbers.
inline void report(const char* operation, int fractionBits, std::initializer_list<std::int64_t> operands) {
  OverflowReport found;
  found.operation = operation;
  found.fractionBits = fractionBits;
  for (const std::int64_t operand : operands) {
    if (found.operandCount == OverflowReport::kMaxOperands) break;
    found.operands[static_cast<std::size_t>(found.operandCount++)] = operand;
  }
  currentOverflowHandler()(found);
}

}  // namespace raw
}  // namespace samestep
