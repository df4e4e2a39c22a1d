#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <initializer_list>
#include <string>

#include "samestep/raw_decimal.h"

namespace samestep {

/// What a checked number met: an overflow, a lost quotient or an argument outside the domain.
struct OverflowReport {
  static constexpr int kMaxOperands = 8;

  const char* operation = "";                         ///< name of the function, "multiply" for the operator *
  std::array<std::int64_t, kMaxOperands> operands{};  ///< raw, in the order of the call
  int operandCount = 0;
  int fractionBits = 0;  ///< of the operands

  /// "multiply(2147483647, 2)"
  std::string text() const {
    std::string result = std::string(operation) + "(";
    for (int i = 0; i < operandCount; ++i) {
      if (i > 0) result += ", ";
      result += raw::formatDecimal(operands[static_cast<std::size_t>(i)], fractionBits).view();
    }
    return result + ")";
  }
};

/// Thrown by the default handler; what() names the operation and its operands.
class FixedOverflow : public std::exception {
 public:
  explicit FixedOverflow(const OverflowReport& report) : report_(report), text_(report.text()) {}

  const OverflowReport& report() const { return report_; }
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  OverflowReport report_;
  std::string text_;
};

/// Told of each report. If it returns, the operation gives what the wrapping number gives.
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
