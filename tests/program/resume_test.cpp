// A run that was stopped, killed or lengthened goes on with the same bits: its files are those of a run that never was.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "case_text.hpp"
#include "parsed_json.hpp"
#include "pictures.hpp"
#include "program/program.hpp"
#include "program/same_run.hpp"

namespace gaussdrift {
namespace {

/// Some 0.7 s: 200 000 steps of few particles, three outputs.
const std::string turning =
    case_text({.density = shape_of("wendland", "0.5, 0", "0.25"),
               .particles = "per_axis = 60",
               .time = "end = 4\nstep = 0.00002",
               .evaluate = "per_axis = 40",
               .output = "times = [0, 1.5, 3, 4]\nimages = []\nreport = \"none\"\ncheckpoint = 0.02"});

/// Starts the program, sends a signal some milliseconds after its first output, and returns what waitpid() says.
int run_and_signal(const ScratchFolder& folder, const std::vector<std::string>& words, int signal, int milliseconds) {
  const pid_t child = fork();
  if (child == 0) {
    if (chdir(folder.path().c_str()) != 0) _exit(99);
    if (!freopen("out.txt", "w", stdout) || !freopen("err.txt", "w", stderr)) _exit(99);
    std::vector<char*> arguments{const_cast<char*>(PROGRAM)};
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    execv(PROGRAM, arguments.data());
    _exit(99);
  }
  constexpr int most_waits = 20000;
  for (int i = 0; i < most_waits && !fs::exists(folder / "part/series.csv"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
  kill(child, signal);
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

class Resume : public testing::Test {
 protected:
  Resume() {
    std::ofstream(folder / "turning.toml") << turning;
    EXPECT_EQ(gaussdrift_in(folder, "run turning.toml --out whole").exit_code, 0);
  }
  const ScratchFolder folder;
};

TEST_F(Resume, AfterAStopByTheClock) {
  Outcome stopped = gaussdrift_in(folder, "run turning.toml --out part --stop-after 0.05");
  int stops = 0;
  for (; stopped.exit_code == 7 && stops < 10; ++stops) {
    EXPECT_NE(stopped.err.find("resume with: gaussdrift resume part"), std::string::npos) << stopped.err;
    EXPECT_FALSE(parsed_json(read_file(folder / "part/summary.json")).at("complete").get<bool>());
    stopped = gaussdrift_in(folder, "resume part --stop-after 0.05");
  }
  if (stopped.exit_code == 7) stopped = gaussdrift_in(folder, "resume part");
  EXPECT_EQ(stopped.exit_code, 0) << stopped.err;
  EXPECT_GT(stops, 0);
  expect_same(folder / "whole", folder / "part");
}

/// The budget is of the last output, and steps come after it: another process has them.
TEST_F(Resume, AfterItsLastOutputWithTheErrorBudgetOfTheUnbrokenRun) {
  const std::string run = "run turning.toml --set output.times=[0,0.04] --set 'accuracy.budget=\"measured\"' --out ";
  const auto summary_of = [&](const char* name) {
    return nlohmann::json::parse(read_file(folder / name / "summary.json"));
  };
  ASSERT_EQ(gaussdrift_in(folder, run + "unbroken").exit_code, 0);
  Outcome stopped = gaussdrift_in(folder, run + "part --stop-after 0.05");
  for (int stops = 0; stopped.exit_code == 7 && summary_of("part").at("frames").size() < 2 && stops < 100; ++stops)
    stopped = gaussdrift_in(folder, "resume part --stop-after 0.05");
  ASSERT_EQ(stopped.exit_code, 7) << stopped.err;
  EXPECT_FALSE(summary_of("part").contains("budget"));
  stopped = gaussdrift_in(folder, "resume part");
  EXPECT_EQ(stopped.exit_code, 0) << stopped.err;
  EXPECT_EQ(stopped.err.find("warning"), std::string::npos) << stopped.err;
  ASSERT_TRUE(summary_of("unbroken").contains("budget"));
  EXPECT_TRUE(summary_of("unbroken").at("budget").at("measured").at("total").is_number());
  EXPECT_EQ(summary_of("unbroken").at("budget"), summary_of("part").at("budget"));
  expect_same(folder / "unbroken", folder / "part");
}

TEST_F(Resume, AfterSignalsWhichItAnswersWithTheirExitCodes) {
  for (const auto& [signal, code] : {std::pair{SIGINT, 130}, {SIGTERM, 143}, {SIGHUP, 129}}) {
    fs::remove_all(folder / "part");
    // So many steps that it is under way when the signal comes, however busy the machine is.
    const int status =
        run_and_signal(folder, {"run", "turning.toml", "--out", "part", "--set", "time.step=1e-8"}, signal, 50);
    ASSERT_TRUE(WIFEXITED(status)) << signal;
    EXPECT_EQ(WEXITSTATUS(status), code) << read_file(folder / "err.txt");
    EXPECT_NE(read_file(folder / "err.txt").find("resume with: gaussdrift resume part"), std::string::npos);
    EXPECT_TRUE(fs::exists(folder / "part/state"));
  }
}

/// Most of its time goes into three outputs: densities, paths back from their points, files, pictures.
const std::string showing = case_text({.velocity = velocity_of({"-y*(1+x*x)", "x*(1+0.3*sin(y))"}),
                                       .density = shape_of("gaussian", "0.2, 0", "0.3"),
                                       .particles = "per_axis = 60",
                                       .time = "end = 1\nstep = 0.05",
                                       .evaluate = "per_axis = 100",
                                       .output = "frames = 3\nreport = \"none\""});

TEST_F(Resume, AfterSignalsInTheMiddleOfOutputs) {
  std::ofstream(folder / "showing.toml") << showing << (draws_pictures ? "images = [\"heatmap\"]\n" : "images = []\n");
  ASSERT_EQ(gaussdrift_in(folder, "run showing.toml --out shown").exit_code, 0);
  for (const int milliseconds : {0, 30}) {
    fs::remove_all(folder / "part");
    const int status = run_and_signal(folder, {"run", "showing.toml", "--out", "part"}, SIGTERM, milliseconds);
    ASSERT_TRUE(WIFEXITED(status));
    // 0: on a busy machine the run was over when the signal was sent.
    ASSERT_TRUE(WEXITSTATUS(status) == 143 || WEXITSTATUS(status) == 0) << read_file(folder / "err.txt");
    const Outcome resumed = gaussdrift_in(folder, "resume part");
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    expect_same(folder / "shown", folder / "part");
  }
}

TEST_F(Resume, AfterAKill) {
  for (const int milliseconds : {0, 50, 200}) {
    fs::remove_all(folder / "part");
    run_and_signal(folder, {"run", "turning.toml", "--out", "part"}, SIGKILL, milliseconds);
    const Outcome resumed = gaussdrift_in(folder, "resume part");
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    expect_same(folder / "whole", folder / "part");
  }
}

TEST_F(Resume, UntilALaterEnd) {
  EXPECT_EQ(gaussdrift_in(folder, "run turning.toml --set time.end=5 --set output.times=[0,1.5,3,4,5] --out longer")
                .exit_code,
            0);
  const Outcome lengthened = gaussdrift_in(folder, "resume whole --until 5");
  EXPECT_EQ(lengthened.exit_code, 0) << lengthened.err;
  EXPECT_NE(lengthened.err.find("changed from now on: output.times, time.end"), std::string::npos) << lengthened.err;
  expect_same(folder / "longer", folder / "whole");
  EXPECT_NE(gaussdrift_in(folder, "resume whole --until 6 --set output.report=none").out.find("6 frames"),
            std::string::npos)
      << "another key of [output] leaves the outputs at the same distance";
  EXPECT_EQ(gaussdrift_in(folder, "resume whole --until 2").exit_code, 3) << "before the checkpoint";
  EXPECT_NE(gaussdrift_in(folder, "resume whole").out.find("is complete"), std::string::npos);
}

TEST_F(Resume, RefusesToChangeThePastByName) {
  gaussdrift_in(folder, "run turning.toml --out part --stop-after 0.05");
  const Outcome refused = gaussdrift_in(folder, "resume part --set time.step=0.001 --set particles.overlap=2.5");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("particles.overlap, time.step cannot change while a run is under way"), std::string::npos)
      << refused.err;
}

/// What is refused changes nothing, so nothing is told to change.
TEST_F(Resume, TellsWhatChangesOnceNothingIsRefused) {
  ASSERT_EQ(gaussdrift_in(folder, "run turning.toml --out part --stop-after 0.1").exit_code, 7);
  const std::string more = "resume part --set output.times=[0,0.00001,1.5,3,3.5,4]";
  const Outcome refused = gaussdrift_in(folder, more + " --memory 1kB");
  EXPECT_EQ(refused.exit_code, 3) << refused.err;
  EXPECT_EQ(refused.err.find("changed from now on"), std::string::npos) << refused.err;
  EXPECT_EQ(refused.err.find("goes on at"), std::string::npos) << refused.err;
  const Outcome resumed = gaussdrift_in(folder, more);
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_NE(resumed.err.find("warning: no output at t = 1e-05: the run is at t = "), std::string::npos) << resumed.err;
  EXPECT_NE(resumed.err.find("changed from now on: output.times\n"), std::string::npos) << resumed.err;
  EXPECT_NE(resumed.out.find("5 frames"), std::string::npos) << resumed.out;
}

TEST_F(Resume, TellsWhichFilesOfEarlierOutputsAreGone) {
  ASSERT_EQ(gaussdrift_in(folder, "run turning.toml --out part --set output.piece_particles=100").exit_code, 0);
  EXPECT_EQ(gaussdrift_in(folder, "resume part").err, "");
  ASSERT_TRUE(fs::remove(folder / "part/particles/particles_0002/0001.vtp"));
  const Outcome one = gaussdrift_in(folder, "resume part");
  EXPECT_NE(one.err.find("warning: a file of earlier outputs is not there: part/particles/particles_0002/0001.vtp. "),
            std::string::npos)
      << one.err;
  fs::remove_all(folder / "part/density");
  const Outcome more = gaussdrift_in(folder, "resume part --until 4.1");
  EXPECT_EQ(more.exit_code, 0) << more.err;
  EXPECT_NE(
      more.err.find("warning: 5 files of earlier outputs are not there: part/density/density_0000.vti and others. "),
      std::string::npos)
      << more.err;
  EXPECT_NE(more.err.find("gaussdrift run part/run.toml --out DIR"), std::string::npos) << more.err;
}

/// It is told that nothing is kept to go on from, by the message and by the folder.
TEST_F(Resume, WithoutCheckpointsBeginsAgainAndSaysSo) {
  const Outcome stopped =
      gaussdrift_in(folder, "run turning.toml --out part --stop-after 0.1 --set output.checkpoint=0");
  ASSERT_EQ(stopped.exit_code, 7) << stopped.err;
  const std::string words =
      "resume with: gaussdrift resume part. It begins again from the start, because there is no checkpoint "
      "(output.checkpoint = 0). What is written is kept until it has its first output";
  EXPECT_NE(stopped.err.find(words), std::string::npos) << stopped.err;
  EXPECT_NE(stopped.out.find(words), std::string::npos) << stopped.out;
  const auto status = parsed_json(read_file(folder / "part/status.json"));
  EXPECT_EQ(status.at("state"), "interrupted");
  EXPECT_EQ(status.at("next"), words);
  const Outcome resumed = gaussdrift_in(folder, "resume part");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_NE(resumed.err.find("there is no checkpoint; the run begins again"), std::string::npos) << resumed.err;
  for (const auto& [name, bytes] : bits_of(folder / "whole"))
    if (name != "run.toml" && name != "case.toml") {
      EXPECT_TRUE(bits_of(folder / "part")[name] == bytes) << name;
    }
}

TEST_F(Resume, BeginsAgainWhereThereIsNoCheckpointAndTakesTheOlderOfADamagedOne) {
  gaussdrift_in(folder, "run turning.toml --out part --stop-after 0.1");
  const auto serial = [&](const char* slot) {
    const std::string text = read_file(folder / (std::string("part/state/") + slot + "/manifest.json"));
    return text.empty() ? 0 : parsed_json(text).at("serial").get<int>();
  };
  const bool two = serial("1") > 0;
  std::ofstream(folder / (serial("1") > serial("0") ? "part/state/1/run.raw" : "part/state/0/run.raw"), std::ios::app)
      << "x";
  const Outcome older = gaussdrift_in(folder, "resume part");
  EXPECT_EQ(older.exit_code, 0) << older.err;
  EXPECT_NE(older.err.find(two ? "is not used: run.raw has" : "the run begins again"), std::string::npos) << older.err;
  expect_same(folder / "whole", folder / "part");
  EXPECT_EQ(gaussdrift_in(folder, "resume nowhere").exit_code, 6);
}

/// A part of the run that writes other files meets those of others.
TEST_F(Resume, ReplacesNoFileOfOthers) {
  ASSERT_EQ(gaussdrift_in(folder, "run turning.toml --out part --stop-after 0.1").exit_code, 7);
  fs::create_directory(folder / "part/images");
  std::ofstream(folder / "part/images/heatmap_0003.png") << "mine";
  const std::string resume = R"(resume part --set 'output.images=["heatmap"]')";
  const Outcome refused = gaussdrift_in(folder, resume);
  EXPECT_EQ(refused.exit_code, 6);
  EXPECT_NE(refused.err.find("images/heatmap_0003.png in it is no file of the run and would be replaced"),
            std::string::npos)
      << refused.err;
  EXPECT_EQ(read_file(folder / "part/images/heatmap_0003.png"), "mine");
  fs::remove(folder / "part/images/heatmap_0003.png");
  EXPECT_EQ(gaussdrift_in(folder, resume).exit_code, 0);
}

TEST_F(Resume, LooksBackAtUnfinishedRuns) {
  gaussdrift_in(folder, "run turning.toml --out part --stop-after 0.1");
  for (const char* verb : {"report part", "compare part whole"}) {
    const Outcome looked = gaussdrift_in(folder, verb);
    EXPECT_EQ(looked.exit_code, 0) << verb << looked.err;
    EXPECT_NE((looked.out + looked.err).find("not complete"), std::string::npos) << verb << looked.out << looked.err;
  }
}

/// status.json of a process that was killed says "running". Whoever looks at the run is told better.
TEST_F(Resume, LooksBackAtRunsWhoseProcessIsGone) {
  ASSERT_EQ(gaussdrift_in(folder, "run turning.toml --out part --stop-after 0.1").exit_code, 7);
  auto status = parsed_json(read_file(folder / "part/status.json"));
  status["state"] = "running";
  write_file(folder / "part/status.json", status.dump());
  for (const char* verb : {"report part", "compare part whole"}) {
    const Outcome looked = gaussdrift_in(folder, verb);
    EXPECT_EQ(looked.exit_code, 0) << verb << looked.err;
    EXPECT_NE(looked.err.find("note: part is not complete: its process was killed, or could not say how it ended; "
                              "gaussdrift resume part goes on"),
              std::string::npos)
        << verb << looked.err;
  }
}

using ResumedPictures = Drawn;

TEST_F(ResumedPictures, HaveTheColoursOfARunThatNeverStopped) {
  const ScratchFolder folder;
  std::ofstream(folder / "growing.toml") << turning << "[effects.reaction]\nrate = \"-0.3\"\n";
  const std::string drawn = R"( --set 'output.images=["heatmap"]' --set output.times=[0,4])";
  EXPECT_EQ(gaussdrift_in(folder, "run growing.toml --out whole" + drawn).exit_code, 0);
  EXPECT_EQ(gaussdrift_in(folder, "run growing.toml --out part --stop-after 0.3" + drawn).exit_code, 7);
  const Outcome resumed = gaussdrift_in(folder, "resume part");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(resumed.err.find("warning"), std::string::npos) << resumed.err;
  EXPECT_TRUE(fs::exists(folder / "whole/images/heatmap_0001.png"));
  expect_same(folder / "whole", folder / "part");
}

TEST_F(ResumedPictures, OfARunWithoutDensityFilesHaveTheColoursOfOneThatWasAlwaysLonger) {
  const ScratchFolder folder;
  std::ofstream(folder / "growing.toml") << turning << "[effects.reaction]\nrate = \"-0.3\"\n";
  const std::string run =
      "run growing.toml --set time.step=0.01 --set 'output.images=[\"heatmap\"]' --set output.vtk=[] ";
  EXPECT_EQ(gaussdrift_in(folder, run + "--set time.end=4 --set output.times=[0,2,4] --out whole").exit_code, 0);
  for (const char* name : {"part", "without"})
    EXPECT_EQ(
        gaussdrift_in(folder, run + "--set time.end=2 --set output.times=[0,2] --out " + std::string(name)).exit_code,
        0);
  const Outcome resumed = gaussdrift_in(folder, "resume part --until 4");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(resumed.err.find("warning"), std::string::npos) << resumed.err;
  for (const char* picture : {"images/heatmap_0000.png", "images/heatmap_0001.png", "images/heatmap_0002.png"})
    EXPECT_TRUE(read_file(folder / "whole" / picture) == read_file(folder / "part" / picture)) << picture;

  fs::remove_all(folder / "without/state/pictures");
  const Outcome narrow = gaussdrift_in(folder, "resume without --until 4");
  EXPECT_EQ(narrow.exit_code, 0) << narrow.err;
  EXPECT_NE(narrow.err.find("1 earlier output keep a narrower range of colours"), std::string::npos) << narrow.err;
}

}  // namespace
}  // namespace gaussdrift
