// SPDX-License-Identifier: MIT
// Drives the built program as a user does.
#include <sys/stat.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace samestep {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

struct Outcome {
  int code = -1;
  std::string out;
  std::string error;
};

std::string contents(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

class ProgramTest : public ::testing::Test {
 protected:
  ProgramTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "samestep-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~ProgramTest() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name) const { return folder_ + "/" + name; }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
  }
  Outcome run(const std::string& arguments) const {
    const std::string command = std::string("'") + SAMESTEP_PROGRAM + "' " + arguments + " >'" + file("out") +
                                "' 2>'" + file("error") + "'";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(file("out")), contents(file("error"))};
  }

 private:
  std::string folder_;
};

TEST_F(ProgramTest, TellsItsVersion) {
  const Outcome outcome = run("--version");

  EXPECT_EQ(outcome.code, 0);
  for (const char* part :
       {"samestep ", "simulation revision ", "scalars ", "fixed", "compiler ", "fingerprint fixed "}) {
    EXPECT_THAT(outcome.out, HasSubstr(part));
  }
}

TEST_F(ProgramTest, HelpExplainsEachWordAndSucceeds) {
  EXPECT_EQ(run("--help").code, 0);
  for (const char* word : {"scenes", "hash", "record", "verify", "diff", "draw", "chart", "envelope"}) {
    EXPECT_THAT(run("--help").out, HasSubstr(word));
    EXPECT_EQ(run(std::string(word) + " --help").code, 0) << word;
  }
}

TEST_F(ProgramTest, UnusableArgumentsExitWithTwoAndSpeakOnTheErrorOutput) {
  for (const char* arguments :
       {"", "dance", "hash", "hash nowhere", "hash stack --scalar float", "hash stack --ticks 0",
        "hash stack --ticks x", "hash stack --every 0", "hash stack --workers 0",
        "hash stack --kernel fastest", "record stack", "record stack -o /no/such/folder/file", "verify",
        "verify /no/such/file", "diff one", "draw stack -o x.svg", "draw stack --tick -1 -o x.svg"}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_NE(outcome.error, "") << arguments;
  }
}

TEST_F(ProgramTest, ScenesListsOneRunnableNamePerLine) {
  const Outcome outcome = run("scenes");

  EXPECT_EQ(outcome.code, 0);
  std::size_t lines = 0;
  std::size_t start = 0;
  for (std::size_t end; (end = outcome.out.find('\n', start)) != std::string::npos; start = end + 1) {
    const std::string line = outcome.out.substr(start, end - start);
    const std::string name = line.substr(0, line.find(' '));
    EXPECT_EQ(run("hash " + name + " --ticks 1").code, 0) << line;
    ++lines;
  }
  EXPECT_GE(lines, 12u);
}

TEST_F(ProgramTest, HashPrintsTickAndHashOfEveryTick) {
  const Outcome outcome = run("hash stack --ticks 3");

  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, MatchesRegex("1 [0-9a-f]{16}\n2 [0-9a-f]{16}\n3 [0-9a-f]{16}\n"));
  EXPECT_THAT(run("hash stack --ticks 7 --every 3").out, MatchesRegex("3 [0-9a-f]{16}\n6 [0-9a-f]{16}\n"));
  EXPECT_EQ(run("hash stack --ticks 3 --scalar checked").out, outcome.out);
  EXPECT_EQ(run("hash stack --ticks 3 --kernel portable --workers 3").out, outcome.out);
}

TEST_F(ProgramTest, RecordsVerifiesAndFindsWhatWasAltered) {
  ASSERT_EQ(run("record bullets -o '" + file("a.rec") + "' --ticks 150").code, 0);

  const Outcome good = run("verify '" + file("a.rec") + "'");
  EXPECT_EQ(good.code, 0);
  EXPECT_THAT(good.out, HasSubstr("all 150 ticks"));
  EXPECT_THAT(good.out, HasSubstr("times real time at 60 Hz"));

  const std::string bytes = contents(file("a.rec"));
  write("cut.rec", bytes.substr(0, bytes.size() / 2));
  write("longer.rec", bytes + "x");
  std::string altered = bytes;
  altered[bytes.size() / 2] = static_cast<char>(altered[bytes.size() / 2] ^ 4);
  write("altered.rec", altered);
  write("empty.rec", "");
  for (const char* name : {"cut.rec", "longer.rec", "altered.rec", "empty.rec"}) {
    const Outcome outcome = run("verify '" + file(name) + "'");
    EXPECT_EQ(outcome.code, 2) << name;
    EXPECT_THAT(outcome.error, HasSubstr(": offset ")) << name;
  }
  // One bad file does not hide the others.
  const Outcome several = run("verify '" + file("cut.rec") + "' '" + file("a.rec") + "'");
  EXPECT_EQ(several.code, 2);
  EXPECT_THAT(several.out, HasSubstr("all 150 ticks"));
}

TEST_F(ProgramTest, VerifyTakesFoldersAndSharesThemOut) {
  std::filesystem::create_directory(file("folder"));
  for (const char* name : {"a", "b", "c", "d"}) {
    const std::string ticks = std::to_string(20 + 10 * (name[0] - 'a'));
    ASSERT_EQ(run("record stack --ticks " + ticks + " -o '" + file("folder/") + name + "'").code, 0);
  }
  write("folder/notes.txt", "no recording");
  const std::string bytes = contents(file("folder/a"));
  write("folder/cut", bytes.substr(0, bytes.size() - 40));

  const Outcome alone = run("verify '" + file("folder") + "'");
  EXPECT_EQ(alone.code, 1);
  EXPECT_THAT(alone.out, HasSubstr("cut: INCOMPLETE: ends after tick 20 without an end"));
  EXPECT_THAT(alone.out, HasSubstr("5 files: 4 verified, 1 incomplete; 160 ticks in "));
  const auto verdictsOf = [&](const std::string& options) {
    std::string lines = run("verify --json " + options + " '" + file("folder") + "'").out;
    for (std::size_t at; (at = lines.find(",\"milliseconds\":")) != std::string::npos;) {
      lines.erase(at, lines.find('}', at) - at);
    }
    return lines;
  };
  const std::string all = verdictsOf("");
  EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 5);
  EXPECT_THAT(all, HasSubstr("\"verdict\":\"incomplete\""));
  EXPECT_EQ(verdictsOf("--jobs 3"), all);
#ifndef __SANITIZE_ADDRESS__  // That takes terabytes of addresses for itself.
  EXPECT_EQ(verdictsOf("--max-memory 4000"), all);
#endif
  // The greatest first: the shards share out the work and have no file in common.
  std::string shards;
  for (const char* shard : {"1/3", "2/3", "3/3"}) {
    const std::string own = verdictsOf(std::string("--shard ") + shard);
    EXPECT_GE(std::count(own.begin(), own.end(), '\n'), 1);
    shards += own;
  }
  EXPECT_EQ(shards.size(), all.size());
  EXPECT_EQ(run("verify --shard 0/3 '" + file("folder") + "'").code, 2);
  EXPECT_EQ(run("verify --shard 4/3 '" + file("folder") + "'").code, 2);
  std::filesystem::create_directory(file("none"));
  EXPECT_THAT(run("verify '" + file("none") + "'").error, HasSubstr("no recordings in this folder"));
}

TEST_F(ProgramTest, ClaimsAreRecordedToldAndChecked) {
  ASSERT_EQ(
      run("record stack --ticks 9 --note level=one --claim samestep.bodies -o '" + file("a.rec") + "'").code,
      0);
  EXPECT_THAT(run("verify '" + file("a.rec") + "'").out, HasSubstr(", 1 claim holds"));
  const Outcome info = run("info --keyframes '" + file("a.rec") + "'");
  EXPECT_EQ(info.code, 0);
  for (const char* told : {"format version 4", "9 ticks of 0.01", "keyframes: 1,", "note level: one",
                           "claim after tick 9: samestep.bodies is "}) {
    EXPECT_THAT(info.out, HasSubstr(told));
  }
  ASSERT_EQ(run("record stack --ticks 9 --claim samestep.bodies=99 -o '" + file("b.rec") + "'").code, 0);
  const Outcome liar = run("verify '" + file("b.rec") + "'");
  EXPECT_EQ(liar.code, 1);
  EXPECT_THAT(liar.out, HasSubstr("FALSE CLAIM: after tick 9, samestep.bodies is not 99"));
  EXPECT_EQ(run("record stack --claim score -o '" + file("c.rec") + "'").code, 2);
}

TEST_F(ProgramTest, AGameHasTheWholeCommandLineWithItsOwnClaims) {
  ASSERT_EQ(run("record stack --ticks 9 --claim height=! -o '" + file("a.rec") + "'").code, 0);
  EXPECT_THAT(run("verify '" + file("a.rec") + "'").out, HasSubstr("1 claims are unknown here"));
  const std::string verify =
      std::string("'") + SAMESTEP_GAME + "' verify '" + file("a.rec") + "' > '" + file("out") + "'";
  const int status = std::system(verify.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  // An exclamation mark is 33 metres.
  EXPECT_THAT(contents(file("out")), HasSubstr("FALSE CLAIM: after tick 9, height is not !"));
}

TEST_F(ProgramTest, VerifyHasLimitsForRecordingsFromStrangers) {
  ASSERT_EQ(run("record stack -o '" + file("a.rec") + "' --ticks 5").code, 0);
  const auto verifyWith = [&](const std::string& option) {
    return run("verify " + option + " '" + file("a.rec") + "'");
  };

  EXPECT_EQ(verifyWith("--max-seconds 1000 --max-bodies 100 --max-shapes 100 --max-pairs 100").code, 0);
  EXPECT_THAT(verifyWith("--max-bodies 5").error, HasSubstr("more bodies than allowed"));
  EXPECT_THAT(verifyWith("--max-shapes 5").error, HasSubstr("more shapes than allowed"));
  EXPECT_THAT(verifyWith("--max-pairs 3").error,
              HasSubstr("more shapes are near each other than the 3 pairs allowed"));
  EXPECT_THAT(verifyWith("--max-substeps 3").error, HasSubstr("more substeps than allowed"));
  EXPECT_THAT(verifyWith("--max-iterations 9").error, HasSubstr("more iterations than allowed"));
  EXPECT_THAT(verifyWith("--max-bytes 100").error, HasSubstr("a.rec: longer than 100 bytes"));
  EXPECT_EQ(
      verifyWith("--max-substeps 4 --max-iterations 10 --max-handlers 0 --max-joints 0 --max-commands 0")
          .code,
      0);
  for (const char* option :
       {"--max-bodies 5", "--max-shapes 5", "--max-pairs 3", "--max-pairs -1", "--max-seconds 0"}) {
    EXPECT_EQ(verifyWith(option).code, 2) << option;
  }
}

TEST_F(ProgramTest, WordsAndOptionsThatAreNoneGetASuggestion) {
  const auto said = [&](const char* arguments) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    return outcome.error;
  };
  EXPECT_EQ(said("hsh stack"), "samestep: no word hsh; did you mean hash?\n");
  EXPECT_THAT(said("foo"), HasSubstr("no word foo; there are scenes, hash, record, verify"));
  EXPECT_EQ(said("hash stack --tick 5"), "samestep: no option --tick; did you mean --ticks?\n");
  EXPECT_EQ(said("verify x --max-body=3"), "samestep: no option --max-body; did you mean --max-bodies?\n");
}

TEST_F(ProgramTest, VerifySaysWhatAFileIsThatIsNoRecording) {
  write("a.txt", "dear verifier\n");
  write("a.json", "{\"samestep\": 1}");
  write("a.bin", std::string("\x00\x01\x02", 3));
  const auto said = [&](const char* name) {
    const Outcome outcome = run("verify '" + file(name) + "'");
    EXPECT_EQ(outcome.code, 2) << name;
    return outcome.error;
  };
  EXPECT_THAT(said("a.txt"), HasSubstr("a.txt: offset 0: this is text, not a recording"));
  EXPECT_THAT(said("a.json"), HasSubstr("this is JSON, perhaps a scene"));
  EXPECT_THAT(said("a.bin"), HasSubstr("a.bin: offset 0: not a recording"));
}

TEST_F(ProgramTest, VerifyHoldsRecordingsAgainstWhatTheMatchWasToBe) {
  ASSERT_EQ(run("record arena -o '" + file("a.rec") + "' --ticks 60").code, 0);
  const auto verifyWith = [&](const std::string& option) {
    return run("verify " + option + " '" + file("a.rec") + "'");
  };

  EXPECT_EQ(verifyWith("--ticks 60 --time-step 1/60 --scalar fixed --first-tick 0").code, 0);
  for (const char* option : {"--ticks 61", "--time-step 1/30", "--scalar double", "--first-tick 1",
                             "--expect-first-hash 0123456789abcdef", "--allow-commands none"}) {
    const Outcome outcome = verifyWith(option);
    EXPECT_EQ(outcome.code, 1) << option;
    EXPECT_THAT(outcome.out, HasSubstr("UNEXPECTED: ")) << option;
  }
  for (const char* option : {"--time-step 60", "--expect-first-hash 12", "--allow-commands teleport"}) {
    EXPECT_EQ(verifyWith(option).code, 2) << option;
  }
}

TEST_F(ProgramTest, OutputFollowsLinksAndGoesThroughPipes) {
  write("real.svg", "old");
  std::filesystem::create_symlink("real.svg", file("link.svg"));
  EXPECT_EQ(run("draw stack --tick 1 -o '" + file("link.svg") + "'").code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(file("link.svg")));
  EXPECT_THAT(contents(file("real.svg")), HasSubstr("</svg>"));

  ASSERT_EQ(mkfifo(file("pipe").c_str(), 0600), 0);
  const std::string reader = "cat '" + file("pipe") + "' >'" + file("read.svg") + "' & ";
  ASSERT_EQ(std::system(reader.c_str()), 0);
  EXPECT_EQ(run("draw stack --tick 1 -o '" + file("pipe") + "'").code, 0);
  EXPECT_TRUE(std::filesystem::is_fifo(file("pipe")));
}

TEST_F(ProgramTest, ATargetThatCannotBeWrittenIsToldBeforeTheRun) {
  const Outcome outcome = run("record stack --ticks 1000000000 -o /no/such/folder/file");

  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.error, HasSubstr("/no/such/folder/file: cannot be written"));
}

TEST_F(ProgramTest, DrawRefusesWhatItWouldNotDo) {
  ASSERT_EQ(run("record stack --ticks 2 -o '" + file("a.rec") + "'").code, 0);
  EXPECT_THAT(run("draw stack --tick 1 -o '" + file("x.png") + "'").error, HasSubstr("written as SVG"));
  EXPECT_THAT(run("draw '" + file("a.rec") + "' --scalar fixed --tick 1 -o '" + file("x.svg") + "'").error,
              HasSubstr("--scalar is for scenes"));
}

TEST_F(ProgramTest, ChartWritesAPictureAndACsvAndTellsTheFront) {
  const Outcome outcome =
      run("chart pyramid:2 --ticks 6 --rounds 1 -o '" + file("a.svg") + "' --csv '" + file("a.csv") + "'");

  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("exact answer"));
  EXPECT_THAT(outcome.out, HasSubstr("ms per simulated second"));
  EXPECT_THAT(outcome.error, HasSubstr("round 1 of 1"));
  EXPECT_THAT(contents(file("a.svg")), HasSubstr("</svg>"));
  EXPECT_THAT(contents(file("a.csv")), HasSubstr("\npyramid:2,fixed soft step,fixed,60,substeps,4,"));
}

TEST_F(ProgramTest, EnvelopeTellsTheLimitsOfALadderAndWhatFailingMeans) {
  const Outcome outcome = run("envelope bullet-6cm --csv '" + file("a.csv") + "'");

  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("\n| fixed soft step, 4 substeps | "));
  EXPECT_THAT(outcome.out, HasSubstr("It fails when "));
  EXPECT_THAT(outcome.out, Not(HasSubstr("stack")));
  EXPECT_THAT(outcome.error, HasSubstr("limits; bullet-6cm, fixed impulses, 10 iterations"));
  EXPECT_THAT(contents(file("a.csv")), HasSubstr("\nbullet-6cm,fixed soft step,4,"));
}

TEST_F(ProgramTest, DiffNamesTickObjectFieldAndInput) {
  const std::string scene =
      R"({"samestep": 1, "bodies": [{"name": "a", "mass": 1, "moment": 1}], "inputs": "keys.csv"})";
  write("scene.json", scene);
  write("keys.csv", "tick,body,do,x,y\n5,a,impulse,1,0\n");
  ASSERT_EQ(run("record '" + file("scene.json") + "' --ticks 20 -o '" + file("a.rec") + "'").code, 0);
  write("keys.csv", "tick,body,do,x,y\n5,a,impulse,1.5,0\n");
  ASSERT_EQ(run("record '" + file("scene.json") + "' --ticks 20 -o '" + file("b.rec") + "'").code, 0);

  const Outcome same = run("diff '" + file("a.rec") + "' '" + file("a.rec") + "'");
  EXPECT_EQ(same.code, 0);
  EXPECT_THAT(same.out, HasSubstr("the same for 20 ticks"));
  const Outcome other = run("diff '" + file("a.rec") + "' '" + file("b.rec") + "'");
  EXPECT_EQ(other.code, 1);
  EXPECT_THAT(other.out, HasSubstr("differ at tick 5"));
  EXPECT_THAT(other.out, HasSubstr("body 1, velocity.x"));
  EXPECT_THAT(other.out, HasSubstr("only B: impulse: body 1"));
  EXPECT_EQ(run("diff '" + file("a.rec") + "' '" + file("scene.json") + "'").code, 2);
}

TEST_F(ProgramTest, DiffTellsItAsDataWithContextAndByAnswers) {
  const std::string scene =
      R"({"samestep": 1, "bodies": [{"name": "a", "mass": 1, "moment": 1}], "inputs": "keys.csv"})";
  write("scene.json", scene);
  const std::string a = "'" + file("a.rec") + "'", b = "'" + file("b.rec") + "'";
  write("keys.csv", "tick,body,do,x,y\n5,a,impulse,1,0\n");
  ASSERT_EQ(run("record '" + file("scene.json") + "' --ticks 20 -o " + a).code, 0);
  write("keys.csv", "tick,body,do,x,y\n5,a,impulse,1.5,0\n");
  ASSERT_EQ(run("record '" + file("scene.json") + "' --ticks 20 -o " + b).code, 0);

  const Outcome json = run("diff --json " + a + " " + b);
  EXPECT_EQ(json.code, 1);
  EXPECT_THAT(json.out,
              HasSubstr("{\"same\":false,\"ticksA\":20,\"ticksB\":20,\"tick\":5,\"stage\":\"commands\""));
  EXPECT_THAT(json.out, HasSubstr("{\"object\":\"body 1\",\"field\":\"velocity.x\",\"a\":\"1 ("));
  EXPECT_THAT(json.out, HasSubstr("\"onlyB\":[\"impulse: body 1"));
  EXPECT_EQ(std::count(json.out.begin(), json.out.end(), '\n'), 1);
  EXPECT_THAT(run("diff --json " + a + " " + a).out, HasSubstr("{\"same\":true,"));
  const Outcome context = run("diff --context 2 " + a + " " + b);
  EXPECT_THAT(context.out, HasSubstr("A after tick 3\n"));
  EXPECT_THAT(context.out, HasSubstr("B after tick 5\n    body 1, "));
  EXPECT_THAT(context.out, HasSubstr("  impulse: body 1 (generation 1), impulse.x 1.5"));
  // Each side with its own recording; only hashes between them.
  const std::string answers = std::string(" --answers \"'") + SAMESTEP_PROGRAM + "' answer ";
  const Outcome apart = run("diff " + a + answers + b + "\"");
  EXPECT_EQ(apart.code, 1) << apart.error;
  EXPECT_THAT(apart.out, HasSubstr("they differ first in tick 5, commands, body, body 1, velocity.x"));
  EXPECT_THAT(apart.out, HasSubstr("\n    A: 1 ("));
  EXPECT_THAT(run("diff " + a + answers + a + "\"").out, HasSubstr("the two are the same, by every hash"));
  EXPECT_EQ(run("diff " + a + " --answers false").code, 2);
  EXPECT_EQ(run("diff " + a).code, 2);
}

TEST_F(ProgramTest, DrawsScenesAndRecordings) {
  ASSERT_EQ(run("draw stack --tick 10 -o '" + file("scene.svg") + "'").code, 0);
  ASSERT_EQ(run("record stack --ticks 10 -o '" + file("a.rec") + "'").code, 0);
  ASSERT_EQ(run("draw '" + file("a.rec") + "' --tick 10 -o '" + file("recording.svg") + "'").code, 0);

  const std::string picture = contents(file("scene.svg"));
  EXPECT_THAT(picture, HasSubstr("<svg "));
  EXPECT_THAT(picture, HasSubstr("</svg>"));
  // The caption, which tells where a picture comes from, is its last line but one.
  const auto withoutCaption = [](const std::string& text) { return text.substr(0, text.rfind("<text")); };
  EXPECT_EQ(withoutCaption(contents(file("recording.svg"))), withoutCaption(picture));
  EXPECT_EQ(run("draw '" + file("a.rec") + "' --tick 11 -o '" + file("late.svg") + "'").code, 2);
}

TEST_F(ProgramTest, FilmsArePicturesThatABrowserPlays) {
  ASSERT_EQ(run("record stack --ticks 90 -o '" + file("a.rec") + "'").code, 0);
  const std::string film = "film '" + file("a.rec") + "' ";
  const Outcome outcome = run(film + "--from 30 --to 80 --follow 3 -o '" + file("a.svg") + "'");
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_THAT(outcome.out, HasSubstr("ticks 30 to 80 of "));
  EXPECT_THAT(contents(file("a.svg")), HasSubstr("<animateTransform "));
  EXPECT_EQ(run(film + "-o '" + file("folder") + "'").code, 0);
  EXPECT_THAT(contents(file("folder/index.html")), HasSubstr("000000.svg"));
  EXPECT_THAT(contents(file("folder/000045.svg")), HasSubstr("tick 90</text>"));
  EXPECT_EQ(run(film + "--follow 99 -o '" + file("b.svg") + "'").code, 2);
  EXPECT_EQ(run(film + "--from 91 -o '" + file("b.svg") + "'").code, 2);
  EXPECT_EQ(run(film + "--max-kilobytes 1 -o '" + file("b.svg") + "'").code, 2);
  ASSERT_EQ(run("record stack --ticks 90 --scalar fixed --note a=b -o '" + file("b.rec") + "'").code, 0);
  EXPECT_EQ(run(film + "'" + file("b.rec") + "' -o '" + file("b.svg") + "'").code, 0);
}

TEST_F(ProgramTest, ScenesAreFoundInTheFolderTheEnvironmentNames) {
  write("mine.json", R"({"samestep": 1, "about": "my own"})");
  ASSERT_EQ(setenv("SAMESTEP_SCENES", file("").c_str(), 1), 0);

  EXPECT_THAT(run("scenes").out, HasSubstr("my own"));
  EXPECT_EQ(run("hash mine --ticks 2").code, 0);
  unsetenv("SAMESTEP_SCENES");
  EXPECT_THAT(run("scenes").out, Not(HasSubstr("my own")));
}

TEST_F(ProgramTest, NetsimPlaysMatchesThatEndTheSameEverywhere) {
  const Outcome outcome = run("netsim --seeds 1-4 --peers 2-5 --ticks 200");

  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("4 matches, 0 failed"));
}

#ifdef SAMESTEP_TRANSPORT
TEST_F(ProgramTest, AMatchOfProcessesLeavesRecordingsThatTheProgramReads) {
  const Outcome outcome = run("match --players 2 --ticks 120 --speed 8 -o '" + file("match") + "'");

  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.error;
  EXPECT_THAT(outcome.out, HasSubstr("2 recordings, each verified, all the same to the last byte"));
  const std::string first = file("match/peer0.rec"), second = file("match/peer1.rec");
  EXPECT_EQ(run("verify '" + first + "'").code, 0);
  EXPECT_THAT(run("diff '" + first + "' '" + second + "'").out, HasSubstr("the same for 120 ticks"));
  EXPECT_EQ(run("match --flip 2@5").code, 2);
}
#endif

TEST_F(ProgramTest, AFailingSeedPrintsTheCommandThatRepeatsIt) {
  const std::string command = "netsim --seeds 3 --peers 4 --ticks 200 --fault loss,drift --plant flip";
  const Outcome outcome = run(command);

  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("again: samestep " + command));
  EXPECT_THAT(outcome.out, HasSubstr("smaller: samestep netsim --seeds 3 --peers 2"));
  EXPECT_EQ(run("netsim --seeds 9-2").code, 2);
  EXPECT_EQ(run("netsim --seeds 1 --fault earthquake").code, 2);
}

}  // namespace
}  // namespace samestep
