// SPDX-License-Identifier: MIT
#include "cli/verify/verify_file.h"

#include <algorithm>
#include <exception>

#include "cli/program.h"
#include "cli/verify/verdict_file.h"
#include "cli/verify/verdict_line.h"

namespace samestep::program {
namespace {

/// Watch of a verification, told after each tick.
struct Watch {
  Progress progress{"verify", 0};
  bool quiet = false;
  std::int64_t end = 0;  ///< Time of the end, by milliseconds(); 0 for none.

  bool after(std::uint64_t done, std::uint64_t total) {
    if (!quiet) progress.at(done, total);
    return !isOver();
  }
  bool isOver() const { return end != 0 && milliseconds() >= end; }
};

std::string number(std::uint64_t value) { return std::to_string(value); }

std::string goodLine(const Judgement& judgement, std::int64_t milliseconds) {
  const VerifyResult& result = judgement.result;
  const std::uint64_t perSecond =
      result.ticks * 1000 / static_cast<std::uint64_t>(std::max<std::int64_t>(milliseconds, 1));
  std::string line = "good: all " + number(result.ticks) + " ticks give the recorded hashes, last " +
                     hex(result.computedHash) + " (" + number(perSecond) + " ticks/s, " +
                     number(perSecond / 60) + " times real time at 60 Hz)";
  if (result.claimsThatHold > 0) {
    line +=
        ", " + number(result.claimsThatHold) + (result.claimsThatHold == 1 ? " claim holds" : " claims hold");
  }
  if (result.claimsUnknown > 0) line += ", " + number(result.claimsUnknown) + " claims are unknown here";
  return line;
}

std::string mismatchLine(const Judgement& judgement) {
  const VerifyResult& result = judgement.result;
  std::string line = "MISMATCH at tick " + number(judgement.tick) + " of " + number(result.ticks) + ": ";
  if (result.keyframeDiffers) return line + judgement.reason;
  line += "recorded " + hex(result.recordedHash) + ", computed " + hex(result.computedHash);
  const std::size_t more = judgement.reason.find(';');
  return more == std::string::npos ? line : line + judgement.reason.substr(more);
}

std::string claimLine(const ClaimAt& claim) {
  return "FALSE CLAIM: after tick " + number(claim.tick) + ", " + printable(claim.key) + " is not " +
         printable({claim.value.begin(), claim.value.end()});
}

/// Line for people, on the standard output; empty for what belongs to the error output.
std::string lineFor(const Judgement& judgement, std::int64_t milliseconds) {
  switch (judgement.verdict) {
    case Verdict::verified:
      return goodLine(judgement, milliseconds);
    case Verdict::sampled:
      return "SAMPLED: " + judgement.reason + "; those give the recorded hashes";
    case Verdict::mismatch:
      return mismatchLine(judgement);
    case Verdict::falseClaim:
      return claimLine(*judgement.result.falseClaim);
    case Verdict::unexpected: {
      const std::string line = "UNEXPECTED: " + judgement.reason;
      return judgement.offset == 0 ? line : line + " (offset " + number(judgement.offset) + ")";
    }
    case Verdict::incomplete:
      return "INCOMPLETE: " + judgement.reason +
             (judgement.result.matches ? "; all of them give the recorded hashes" : "");
    default:
      return {};
  }
}

Said say(const std::string& file, const Judgement& judgement, const VerifyPlan& plan,
         std::int64_t milliseconds) {
  Said said;
  said.verdict = judgement.verdict;
  said.ticks = judgement.result.ticks;
  if (plan.json) {
    said.out = verdictLine(file, judgement, askedOf(plan.options), milliseconds);
    return said;
  }
  const std::string line = lineFor(judgement, milliseconds);
  if (!line.empty()) {
    said.out = file + ": " + line + "\n";
  } else if (judgement.verdict == Verdict::stopped) {
    said.error = "samestep: " + file + ": takes longer than " + std::to_string(plan.seconds) + " s\n";
  } else {
    said.error =
        "samestep: " + file + ": offset " + number(judgement.offset) + ": " + judgement.reason + "\n";
  }
  return said;
}

}  // namespace

Said saidUnusable(const std::string& file, const std::string& reason, bool settled, const VerifyPlan& plan) {
  Said said;
  Judgement judgement;
  judgement.reason = reason;
  judgement.settled = settled;
  if (plan.json) {
    judgement.content = contentOf(file, plan.options.limits.bytes);
    said.out = verdictLine(file, judgement, askedOf(plan.options), 0);
  } else {
    said.error = "samestep: " + reason + "\n";
  }
  return said;
}

Said verifyFile(const std::string& file, const VerifyPlan& plan) {
  try {
    const std::vector<std::uint8_t> bytes = readRecording(file, plan.options.limits.bytes);
    const std::int64_t start = milliseconds();
    Watch watch;
    watch.quiet = plan.quiet;
    if (plan.seconds != 0) watch.end = start + plan.seconds * 1000;
    VerifyOptions options = plan.options;
    options.data = &watch;
    options.progress = [](std::uint64_t done, std::uint64_t total, void* data) {
      return static_cast<Watch*>(data)->after(done, total);
    };
    if (plan.seconds != 0) {
      options.interrupt = {[](void* data) { return static_cast<const Watch*>(data)->isOver(); }, &watch};
    }
    const Judgement judgement = judge(bytes, *plan.wirings, options);
    const std::int64_t took = milliseconds() - start;
    watch.progress.clear();
    return say(file, judgement, plan, took);
  } catch (const FormatError& error) {
    const std::string place = file + ": offset " + std::to_string(error.offset()) + ": ";
    return saidUnusable(file, place + error.what(), true, plan);
  } catch (const Unusable& error) {
    return saidUnusable(file, error.what(), true, plan);
  }
}

int exitCodeOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::verified:
    case Verdict::sampled:
      return kGood;
    case Verdict::mismatch:
    case Verdict::falseClaim:
    case Verdict::unexpected:
    case Verdict::incomplete:
      return kMismatch;
    default:
      return kUnusable;
  }
}

}  // namespace samestep::program
