// SPDX-License-Identifier: MIT
// Batches of recordings, as on a cluster: shards, files of verdicts, their merging, processes that can do
// little.
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace samestep {
namespace {

using ::testing::HasSubstr;
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

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

class VerifyBatchTest : public ::testing::Test {
 protected:
  VerifyBatchTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "samestep-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~VerifyBatchTest() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name) const { return folder_ + "/" + name; }
  std::string quoted(const std::string& name) const { return "'" + file(name) + "'"; }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
  }
  Outcome runProgram(const std::string& program, const std::string& arguments) const {
    const std::string command =
        "'" + program + "' " + arguments + " >" + quoted("out") + " 2>" + quoted("error");
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(file("out")), contents(file("error"))};
  }
  Outcome run(const std::string& arguments) const { return runProgram(SAMESTEP_PROGRAM, arguments); }
  /// Makes `count` recordings of different lengths in a folder.
  void record(int count) const {
    std::filesystem::create_directory(file("recordings"));
    for (int i = 0; i < count; ++i) {
      const std::string ticks = std::to_string(5 + 7 * i);
      ASSERT_EQ(
          run("record stack --ticks " + ticks + " -o " + quoted("recordings/" + std::to_string(i))).code, 0);
    }
  }

 private:
  std::string folder_;
};

TEST_F(VerifyBatchTest, ShardsHoldEachFileOnceAndAreThoseOfVerify) {
  record(7);
  const Outcome outcome = run("shards 3 " + quoted("recordings") + " -o " + quoted("lists"));

  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("7 files in 3 shards, of which the greatest has "));
  std::string all;
  for (int shard = 1; shard <= 3; ++shard) {
    const std::string name = std::to_string(shard);
    const std::string list = contents(file("lists/" + name + ".list"));
    all += list;
    const std::string listed = run("verify - --json < " + quoted("lists/" + name + ".list")).out;
    EXPECT_EQ(lines(listed), lines(list));
    EXPECT_EQ(lines(run("verify --json --shard " + name + "/3 " + quoted("recordings")).out), lines(list));
  }
  EXPECT_EQ(lines(all), 7u);
  for (int i = 0; i < 7; ++i) EXPECT_THAT(all, HasSubstr(file("recordings/" + std::to_string(i)) + "\n"));
}

TEST_F(VerifyBatchTest, AShardWithoutFilesIsDoneAndABatchWithoutAnyIsUnusable) {
  record(2);
  const Outcome empty = run("verify --shard 3/3 " + quoted("recordings"));
  EXPECT_EQ(empty.code, 0);
  EXPECT_THAT(empty.out, HasSubstr("0 files; 0 ticks"));
  EXPECT_EQ(run("verify - </dev/null").code, 2);
  EXPECT_EQ(run("shards 2 - -o " + quoted("lists") + " </dev/null").code, 2);
}

TEST_F(VerifyBatchTest, AFileOfVerdictsIsWholeAndGoesOnFromWhatWasThere) {
  record(4);
  const std::string verify = "verify --json --jobs 2 -o " + quoted("v.jsonl") + " " + quoted("recordings");
  ASSERT_EQ(run(verify).code, 0);
  const std::string all = contents(file("v.jsonl"));
  EXPECT_EQ(lines(all), 4u);
  // A run that was ended left two lines, the second of them cut.
  const std::size_t first = all.find('\n') + 1;
  std::filesystem::remove(file("v.jsonl"));
  write("v.jsonl.other-1.part", all.substr(0, all.find('\n', first) - 5));
  const Outcome again = run(verify);
  EXPECT_EQ(again.code, 0);
  EXPECT_THAT(again.error, HasSubstr("4 files: 4 verified; 1 verdicts were there"));
  EXPECT_EQ(lines(contents(file("v.jsonl"))), 4u);
  EXPECT_THAT(contents(file("v.jsonl")), HasSubstr(all.substr(0, first)));
  EXPECT_FALSE(std::filesystem::exists(file("v.jsonl.other-1.part")));
  // A verdict on another question is another one.
  EXPECT_THAT(
      run("verify --max-bodies 1000 --json -o " + quoted("v.jsonl") + " " + quoted("recordings")).error,
      Not(HasSubstr("were there")));
  // A file that changed is verified again.
  std::filesystem::copy_file(file("recordings/0"), file("recordings/1"),
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(
      run("verify --max-bodies 1000 --json -o " + quoted("v.jsonl") + " " + quoted("recordings")).error,
      HasSubstr("3 verdicts were there"));
}

TEST_F(VerifyBatchTest, MergeKeepsEachVerdictOnceAndListsWhatIsMissing) {
  record(5);
  std::filesystem::create_directory(file("verdicts"));
  run("verify --json --shard 1/2 " + quoted("recordings") + " > " + quoted("verdicts/1.jsonl"));
  ASSERT_EQ(
      run("verify --json --shard 1/2 -o " + quoted("verdicts/1.jsonl") + " " + quoted("recordings")).code, 0);
  std::filesystem::copy_file(file("verdicts/1.jsonl"), file("verdicts/1.jsonl.other-2.part"));
  const std::size_t had = lines(contents(file("verdicts/1.jsonl")));

  const std::string merge = "merge " + quoted("verdicts") + " --wanted " + quoted("recordings") + " -o " +
                            quoted("all.jsonl") + " --missing " + quoted("missing");
  const Outcome half = run(merge);
  EXPECT_EQ(half.code, 1);
  EXPECT_THAT(half.error, HasSubstr(std::to_string(had) + " doubles"));
  EXPECT_EQ(lines(contents(file("missing"))), 5 - had);
  // The list of what is missing is one that verify takes.
  ASSERT_EQ(run("verify --json -o " + quoted("verdicts/2.jsonl") + " - <" + quoted("missing")).code, 0);
  const Outcome whole = run(merge);
  EXPECT_EQ(whole.code, 0);
  EXPECT_THAT(whole.error, HasSubstr("5 verdicts: 5 verified"));
  EXPECT_THAT(whole.error, HasSubstr("0 of 5 files are missing"));
  EXPECT_EQ(lines(contents(file("all.jsonl"))), 5u);
  EXPECT_EQ(contents(file("missing")), "");
}

TEST_F(VerifyBatchTest, MergeTellsOfTwoVerdictsForTheSameBytes) {
  record(1);
  const std::string line = run("verify --json " + quoted("recordings/0")).out;
  std::string other = line;
  other.replace(other.find("verified"), 8, "mismatch");
  write("a.jsonl", line);
  write("b.jsonl", other);

  const Outcome outcome = run("merge " + quoted("a.jsonl") + " " + quoted("b.jsonl"));
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.error, HasSubstr("is verified by one run and mismatch by another"));
}

TEST_F(VerifyBatchTest, NamesAreKeptByteForByte) {
  record(1);
  const std::string name =
      "r\xc3\xa9"
      "c\xff \"1\"";
  std::filesystem::rename(file("recordings/0"), file("recordings/" + name));
  ASSERT_EQ(run("verify --json -o " + quoted("v.jsonl") + " " + quoted("recordings")).code, 0);
  const Outcome outcome = run("merge " + quoted("v.jsonl") + " --wanted " + quoted("recordings"));
  EXPECT_EQ(outcome.code, 0) << outcome.error;
}

TEST_F(VerifyBatchTest, ASampleOfStretchesIsAVerdictOfItsOwn) {
  const std::string scene = quoted("a.rec");
  // Keyframes of such a scene come every 600 ticks.
  ASSERT_EQ(run("record stack --ticks 4000 -o " + scene).code, 0);
  const Outcome outcome = run("verify --json --sample 30 --seed 7 " + scene);
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("\"verdict\":\"sampled\""));
  EXPECT_THAT(outcome.out, HasSubstr("\"ticksCompared\":"));
  EXPECT_THAT(run("verify --json --sample 100 " + scene).out, HasSubstr("\"verdict\":\"verified\""));
  EXPECT_EQ(run("verify --sample 0 " + scene).code, 2);
}

TEST_F(VerifyBatchTest, ASampleOfFilesIsDrawnBySeed) {
  record(12);
  const auto drawn = [&](const std::string& seed) {
    return run("shards 1 --sample-files 40 --seed " + seed + " " + quoted("recordings") + " -o " +
               quoted(seed))
                       .code == 0
               ? contents(file(seed + "/1.list"))
               : std::string();
  };
  EXPECT_LT(lines(drawn("1")), 12u);
  EXPECT_EQ(drawn("1"), drawn("1"));
  EXPECT_NE(drawn("1"), drawn("2"));
}

TEST_F(VerifyBatchTest, ARecordingOfAnotherRevisionIsJudgedByItsOwnProgram) {
  record(2);
  std::string old = contents(file("recordings/1"));
  old[12] = 3;
  write("recordings/1", old);
  const Outcome alone = run("verify --json " + quoted("recordings"));
  EXPECT_EQ(alone.code, 2);
  EXPECT_THAT(alone.out, HasSubstr("\"verdict\":\"other revision\""));
  EXPECT_THAT(alone.out, HasSubstr("\"revision\":3"));

  std::filesystem::create_directory(file("programs"));
  write("programs/samestep-3",
        "#!/bin/sh\necho \"$@\" >&2\nwhile read -r name; do echo \"{\\\"file\\\":\\\"$name\\\","
        "\\\"content\\\":\\\"0123456789abcdef\\\",\\\"verifier\\\":3,\\\"asked\\\":\\\"\\\","
        "\\\"verdict\\\":\\\"verified\\\"}\"; done\n");
  std::filesystem::permissions(file("programs/samestep-3"), std::filesystem::perms::owner_all);
  const std::string with = "verify --max-bodies 99 --jobs 2 --with " + quoted("programs");
  const Outcome both = run(with + " --json " + quoted("recordings"));
  EXPECT_EQ(both.code, 0) << both.out << both.error;
  EXPECT_THAT(both.out, HasSubstr("\"verifier\":3"));
  EXPECT_THAT(both.error, HasSubstr("2 files: 2 verified"));
  EXPECT_THAT(both.error, HasSubstr("verify - --json --jobs 2 --max-bodies 99"));
  EXPECT_THAT(run(with + " " + quoted("recordings")).out,
              HasSubstr("1: verified, by the program of revision 3"));
  // One that says nothing leaves the verdict open.
  write("programs/samestep-3", "#!/bin/sh\nexit 0\n");
  const Outcome silent = run(with + " --json " + quoted("recordings"));
  EXPECT_EQ(silent.code, 2);
  EXPECT_THAT(silent.out, HasSubstr("says nothing of it"));
}

#ifdef SAMESTEP_CONFINED
TEST_F(VerifyBatchTest, ProcessesThatVerifyHaveNoNetworkAndWriteNothing) {
  write("victim", "mine");
  ASSERT_EQ(run("record stack --ticks 3 --claim prying=" + quoted("victim") + " -o " + quoted("a.rec")).code,
            0);

  const Outcome outcome = runProgram(SAMESTEP_PRYING_GAME, "verify --jobs 1 " + quoted("a.rec"));
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.error;
  EXPECT_THAT(outcome.out, HasSubstr("1 claim holds"));
  EXPECT_EQ(contents(file("victim")), "mine");
  // The game could do all of it otherwise.
  EXPECT_EQ(runProgram(SAMESTEP_PRYING_GAME, "verify " + quoted("a.rec")).code, 1);
}
#endif

TEST_F(VerifyBatchTest, AProcessThatEndsOrHangsCostsItsOwnFileOnly) {
  record(3);
  for (const char* claim : {"crash", "hang"}) {
    ASSERT_EQ(run(std::string("record stack --ticks 3 --claim ") + claim + "=1 -o " +
                  quoted(std::string("recordings/") + claim))
                  .code,
              0);
  }
  const Outcome outcome =
      runProgram(SAMESTEP_PRYING_GAME, "verify --json --jobs 2 --max-seconds 1 " + quoted("recordings"));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(lines(outcome.out), 5u);
  EXPECT_THAT(outcome.error, HasSubstr("5 files: 3 verified, 2 unusable"));
  EXPECT_THAT(outcome.out, HasSubstr("was ended by signal 6"));
  EXPECT_THAT(outcome.out, HasSubstr("was ended by signal 9"));
  EXPECT_THAT(outcome.out, HasSubstr("\"settled\":false"));
}

}  // namespace
}  // namespace samestep
