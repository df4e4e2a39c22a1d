// SPDX-License-Identifier: MIT
#include "cli/verify/verdict_line.h"

#include <cstdio>

#include <nlohmann/json.hpp>

#include <samestep/version.h>

#include "cli/program.h"
#include "state/state_hash.h"

namespace samestep::program {
namespace {

std::string number(std::uint64_t value) { return std::to_string(value); }

/// As a string of JSON: bytes that are no ASCII as escapes, so that a line is one whatever a file is called.
std::string jsonText(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += {'\\', c};
    } else if (c >= ' ' && c <= '~') {
      quoted += c;
    } else {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04x", static_cast<unsigned>(static_cast<unsigned char>(c)));
      quoted += escape;
    }
  }
  return quoted + "\"";
}

/// The bytes that jsonText made escapes of, from the UTF-8 that a reader makes of those.
std::string bytesOf(const std::string& text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const bool two = (c == 0xc2 || c == 0xc3) && i + 1 < text.size();
    bytes += two ? static_cast<char>((c & 3) << 6 | (static_cast<unsigned char>(text[i + 1]) & 63)) : text[i];
    if (two) ++i;
  }
  return bytes;
}

std::string resultFields(const Judgement& judgement) {
  const VerifyResult& result = judgement.result;
  std::string fields = ",\"ticks\":" + number(result.ticks) + ",\"tick\":" + number(judgement.tick) +
                       ",\"recorded\":\"" + hex(result.recordedHash) + "\",\"computed\":\"" +
                       hex(result.computedHash) + "\",\"claims\":{\"hold\":" + number(result.claimsThatHold) +
                       ",\"false\":" + number(result.claimsThatAreFalse) +
                       ",\"unknown\":" + number(result.claimsUnknown) + "}";
  if (result.sampled) fields += ",\"ticksCompared\":" + number(result.ticksCompared);
  if (result.wrongTicks > 0) {
    fields +=
        ",\"wrongTicks\":" + number(result.wrongTicks) + ",\"lastWrongTick\":" + number(result.lastWrongTick);
  }
  return fields;
}

std::string textOf(const nlohmann::json& line, const char* key) {
  const auto found = line.find(key);
  return found == line.end() || !found->is_string() ? std::string() : found->get<std::string>();
}
std::uint64_t numberOf(const nlohmann::json& line, const char* key) {
  const auto found = line.find(key);
  return found == line.end() || !found->is_number_unsigned() ? 0 : found->get<std::uint64_t>();
}

}  // namespace

std::string verdictLine(const std::string& file, const Judgement& judgement, std::uint64_t asked,
                        std::int64_t milliseconds) {
  const VerifyResult& result = judgement.result;
  std::string line = "{\"file\":" + jsonText(file) + ",\"content\":\"" + hex(judgement.content) +
                     "\",\"verifier\":" + number(kSimulationRevision) + ",\"asked\":\"" + hex(asked) +
                     "\",\"verdict\":" + jsonText(verdictName(judgement.verdict));
  if (!judgement.settled) line += ",\"settled\":false";
  if (!judgement.reason.empty()) line += ",\"reason\":" + jsonText(judgement.reason);
  if (judgement.revision != 0) line += ",\"revision\":" + number(judgement.revision);
  if (judgement.offset != 0) line += ",\"offset\":" + number(judgement.offset);
  if (result.ticks != 0) line += resultFields(judgement);
  if (result.falseClaim) {
    line += ",\"falseClaim\":{\"key\":" + jsonText(result.falseClaim->key) +
            ",\"value\":" + jsonText({result.falseClaim->value.begin(), result.falseClaim->value.end()}) +
            "}";
  }
  return line + ",\"milliseconds\":" + number(static_cast<std::uint64_t>(milliseconds)) + "}\n";
}

std::optional<VerdictLine> readVerdictLine(std::string_view line) {
  const nlohmann::json read = nlohmann::json::parse(line.begin(), line.end(), nullptr, false);
  if (!read.is_object()) return std::nullopt;
  VerdictLine found;
  found.file = bytesOf(textOf(read, "file"));
  found.content = textOf(read, "content");
  found.asked = textOf(read, "asked");
  found.verifier = numberOf(read, "verifier");
  found.verdict = textOf(read, "verdict");
  found.reason = bytesOf(textOf(read, "reason"));
  found.settled = read.value("settled", nlohmann::json(true)) != nlohmann::json(false);
  found.ticks = numberOf(read, "ticks");
  found.milliseconds = numberOf(read, "milliseconds");
  if (found.file.empty() || found.content.size() != 16 || found.verdict.empty()) return std::nullopt;
  return found;
}

Verdict verdictNamed(std::string_view name) {
  for (std::size_t i = 0; i < kVerdicts; ++i) {
    if (name == verdictName(static_cast<Verdict>(i))) return static_cast<Verdict>(i);
  }
  return Verdict::unusable;
}

std::uint64_t askedOf(const VerifyOptions& options) {
  const RecordingLimits& limits = options.limits;
  const Expectations& expected = options.expected;
  std::string text;
  const auto put = [&](std::uint64_t value) { text += number(value) + ","; };
  const auto maybe = [&](const auto& value) {
    text += value ? number(static_cast<std::uint64_t>(*value)) + "," : "-,";
  };
  put(limits.bodies);
  put(limits.shapes);
  put(limits.pairs);
  put(limits.handlers);
  put(static_cast<std::uint64_t>(limits.iterations));
  put(static_cast<std::uint64_t>(limits.substeps));
  put(limits.commandsPerTick);
  put(limits.bytes);
  put(limits.work);
  maybe(expected.firstHash);
  maybe(expected.stepsPerSecond);
  maybe(expected.scalar);
  maybe(expected.ticks);
  maybe(expected.firstTick);
  put(expected.commands);
  put(options.mostFirstTick);
  put(options.toTheEnd ? 1 : 0);
  put(options.sample);
  if (options.sample < 100) put(options.sampleSeed);
  return XXH3_64bits(text.data(), text.size());
}

}  // namespace samestep::program
