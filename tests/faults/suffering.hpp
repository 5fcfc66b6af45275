// A run that suffers one fault after another, and what is promised after each: it says so by its exit code, every file is
// whole, and the run that goes on has the bits of one that never failed. tests/faults/preloaded/faults.cpp makes the faults.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "faults/served_program.hpp"
#include "faults/whole_files.hpp"
#include "program/program.hpp"
#include "program/same_run.hpp"

namespace gaussdrift {

/// Three outputs, and a checkpoint at each of them and at the end.
inline std::string small(int per_axis, const char* images, const char* report) {
  return case_text({.velocity = velocity_of({"0.3*x - y", "0.3*y + x"}),
                    .density = shape_of("wendland", "0, 0", "0.4"),
                    .particles = "per_axis = " + std::to_string(per_axis),
                    .time = "end = 0.3\nstep = 0.1",
                    .evaluate = "per_axis = 21",
                    .output = std::string("times = [0, 0.1, 0.3]\nimages = [") + images + "]\nreport = \"" + report +
                              "\"\ncheckpoint = 1e-9"});
}

/// A cone that turns and flows apart.
inline const std::string apart = small(30, "", "none");

/// With pictures and a page.
inline const std::string drawn = small(30, draws_pictures ? "\"heatmap\"" : "", draws_pictures ? "html" : "none");

/// The program may go on to its end (0) where nothing is lost.
inline const std::set<int> of_files{0, 6}, of_memory{0, 3}, of_kills{128 + 9},  // as the shell tells it
    of_signals{0, 128 + 15}, of_second_signals{128 + 15};

/// How many faults a test makes: GAUSSDRIFT_FAULTS (tools/torture), else `usual`.
inline long faults_of_a_test(long usual) {
  const char* text = std::getenv("GAUSSDRIFT_FAULTS");
  return text ? std::max(1L, std::atol(text)) : usual;
}

inline bool many_are_asked() { return std::getenv("GAUSSDRIFT_FAULTS") != nullptr; }

/// At most `count` of the numbers after `least` up to `most`, spread evenly.
inline std::vector<long> spread(long least, long most, long count) {
  count = std::min(most - least, count);
  std::vector<long> numbers;
  for (long i = 0; i < count; ++i) numbers.push_back(least + 1 + (2 * i + 1) * (most - least) / (2 * count));
  return numbers;
}

inline std::string at_call(long call, int error) {
  return "FAULTS_ERROR=" + std::to_string(error) + " FAULTS_AT=" + std::to_string(call);
}

inline std::string signalled_at(long call) { return "FAULTS_ERROR=term FAULTS_AT=" + std::to_string(call); }

inline std::string killed_at(long call) { return "FAULTS_ERROR=kill FAULTS_AT=" + std::to_string(call); }

class Faults : public testing::Test {
 protected:
  struct Counts {
    long calls = 0, allocations = 0, bytes = 0;
  };

  /// Runs it without a fault: what the others are compared with.
  Counts begin(const std::string& text, const std::string& counted = "") {
    write_file(folder / "small.toml", text);
    return begin_with("run small.toml", counted);
  }

  Counts begin_with(const std::string& run, const std::string& counted = "") {
    new_run_ = command_ = run + " --out part";
    const Outcome whole = call(command_, counted);
    usual_end_ = whole.exit_code;
    EXPECT_TRUE(usual_end_ == 0 || usual_end_ == 5) << whole.err;  // 5: a small run of a case fails its checks
    fs::rename(folder / "part", folder / "whole");
    return counts();
  }

  /// From now on part/ is a copy of `before` at first, and the command is this one.
  Counts begin_in(const std::string& before, const std::string& command) {
    command_ = command, before_ = before;
    take_place();
    const Outcome whole = call(command_);
    EXPECT_EQ(whole.exit_code, usual_end_) << whole.err;
    expect_same(folder / "whole", folder / "part");
    fs::remove_all(folder / "part");
    return counts();
  }

  Outcome call(const std::string& arguments, const std::string& faults = "") {
    fs::remove(folder / "report.txt");
    const std::string variables = "FAULTS_FOLDER='" + (fs::canonical(folder.path()) / "part").string() +
                                  "' FAULTS_REPORT='" + (folder / "report.txt").string() + "' " + faults,
                      all = arguments + " --threads " + std::to_string(threads);
    if (from_its_loading)
      return gaussdrift_in(folder, all, "OMP_WAIT_POLICY=passive LD_PRELOAD='" FAULTS_LIBRARY "' " + variables);
    return program_.call(folder, variables, all);
  }

  /// One fault, and all that is promised after it.
  void suffer(const std::string& faults, const std::set<int>& documented) {
    take_place();
    const Outcome outcome = last_ = call(command_, faults);
    const std::string report = read_file(folder / "report.txt");
    SCOPED_TRACE(faults + ", which " + report.substr(0, report.find('\n')));
    ++exits_[outcome.exit_code];
    EXPECT_TRUE(report.starts_with("struck")) << "no fault was made";
    EXPECT_TRUE(documented.contains(outcome.exit_code) || outcome.exit_code == usual_end_)
        << outcome.exit_code << "\n"
        << outcome.out << outcome.err;
    if (outcome.exit_code == 3) expect_a_line_about_memory(outcome.err, faults.find("libraries") == faults.npos);
    const std::string unreadable = unreadable_in(folder / "part");
    EXPECT_EQ(unreadable, "");
    unreadable_ += std::count(unreadable.begin(), unreadable.end(), '\n');
    if (tells_its_end && outcome.exit_code == 6) expect_end_is_told();
    if (!before_.empty()) expect_nothing_lost();
    // A run that could not begin has nothing to go on from, and nothing in the way of the next.
    if (fs::exists(folder / "part")) go_on(outcome);
    fs::remove_all(folder / "part");
  }

  /// One line: what was made, and how it ended. tools/test and tools/torture show it.
  void tell(const std::string& what, long of) {
    long made = 0;
    std::string ends;
    for (const auto& [code, times] : exits_) {
      made += times;
      ends += (ends.empty() ? "" : ", ") + std::to_string(times) + " with " + std::to_string(code);
    }
    std::ostringstream line;
    line << "faults: " << made << " of " << of << " " << what << "; exits: " << ends << "; " << resumed_ << " resumed, "
         << begun_again_ << " begun again; unreadable files: " << unreadable_ << (HasFailure() ? "; FAILED" : "")
         << "\n";
    std::cout << line.str() << std::flush;
    if (const char* file = std::getenv("GAUSSDRIFT_FAULTS_TOLD")) std::ofstream(file, std::ios::app) << line.str();
    exits_.clear();
    resumed_ = begun_again_ = unreadable_ = 0;
  }

  const ScratchFolder folder;
  int threads = 1;
  bool from_its_loading = false;  // faults before main, too
  bool tells_its_end = false;     // where files fail, the folder says so
  Outcome last_;                  // of the command that suffered last

 private:
  Counts counts() const {
    Counts counts;
    std::istringstream report(read_file(folder / "report.txt"));
    std::string word;
    report >> word >> counts.calls >> word >> counts.allocations >> word >> counts.bytes;
    EXPECT_GT(counts.calls, 50) << "the library that makes faults was not there";
    EXPECT_GT(counts.allocations, 100);
    return counts;
  }

  void take_place() const {
    if (!before_.empty()) fs::copy(folder / before_, folder / "part", fs::copy_options::recursive);
  }

  /// `one`: libraries may add their own.
  void expect_a_line_about_memory(const std::string& err, bool one) const {
    const auto at = err.find("out of memory");
    EXPECT_NE(at, std::string::npos) << err;
    if (one) {
      EXPECT_EQ(err.find("out of memory", at + 1), std::string::npos) << err;
    }
  }

  /// A run that has begun to write says that it is no longer running.
  void expect_end_is_told() const {
    if (!fs::exists(folder / "part/status.json")) return;
    EXPECT_NE(status_of("part").at("state"), "running");
  }

  /// What was in part/ is there or in part/earlier/, until the new run has an output.
  void expect_nothing_lost() const {
    const fs::path earlier = folder / "part/earlier";
    const auto whole = bits_of(folder / "whole"), now = bits_of(folder / "part"),
               aside = fs::exists(earlier) ? bits_of(earlier) : std::map<std::string, std::string>();
    const std::string first = "density/density_0000.vti";
    if (now.contains(first) && now.at(first) == whole.at(first)) return;
    for (const auto& [name, bytes] : bits_of(folder / before_))
      EXPECT_TRUE((now.contains(name) && now.at(name) == bytes) || (aside.contains(name) && aside.at(name) == bytes))
          << name << " is lost";
  }

  void go_on(const Outcome& before) {
    const fs::path resolved = folder / "part/run.toml";
    const bool can = fs::exists(resolved) && read_file(resolved) == read_file(folder / "whole/run.toml");
    const Outcome again = call(can ? "resume part" : new_run_ + " --force");
    ++(can ? resumed_ : begun_again_);
    ASSERT_TRUE(again.exit_code == usual_end_ || (again.exit_code == 0 && is_complete(again)))
        << before.err << again.err;
    if (command_.starts_with("resume")) {
      EXPECT_EQ(again.err.find("there is no checkpoint"), std::string::npos) << again.err;
    }
    if (before.err.find("gaussdrift report part makes it later") != std::string::npos) {
      const Outcome page = gaussdrift_in(folder, "report part");
      EXPECT_EQ(page.exit_code, 0) << page.err;
    }
    EXPECT_EQ(unreadable_in(folder / "part"), "");
    // A complete run is not written again, so a hidden file that could not be removed stays until somebody writes there.
    if (!is_complete(again)) {
      EXPECT_EQ(left_over_in(folder / "part"), "");
    }
    EXPECT_EQ(left_over_in(folder / "whole"), "");
    expect_same(folder / "whole", folder / "part");
    const auto whole = status_of("whole"), part = status_of("part");
    for (const char* member : {"state", "outputs", "last_output", "files"})
      EXPECT_EQ(whole.at(member), part.at(member)) << member;
  }

  static bool is_complete(const Outcome& resumed) { return resumed.out.find("is complete") != std::string::npos; }

  nlohmann::json status_of(const char* run) const {
    return nlohmann::json::parse(read_file(folder / run / "status.json"), nullptr, false);
  }

  ServedProgram program_;
  std::string command_, new_run_, before_;
  int usual_end_ = 0;
  std::map<int, long> exits_;
  long resumed_ = 0, begun_again_ = 0, unreadable_ = 0;
};

}  // namespace gaussdrift
