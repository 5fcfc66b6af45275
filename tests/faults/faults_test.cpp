// Whatever fails while a run writes, or wherever it is killed: it says so by its exit code, every file is whole, and the run
// that goes on has the bits of one that never failed. tests/faults/preloaded/faults.cpp makes the faults.
#include <expat.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

#include "program/program.hpp"
#include "program/same_run.hpp"

namespace gaussdrift {
namespace {

/// Three outputs, and a checkpoint at each of them and at the end.
std::string small(const std::string& velocity, const char* images, const char* report) {
  return case_text({.velocity = velocity,
                    .density = shape_of("wendland", "0, 0", "0.4"),
                    .particles = "per_axis = 30",
                    .time = "end = 0.3\nstep = 0.1",
                    .evaluate = "per_axis = 21",
                    .output = std::string("times = [0, 0.1, 0.3]\nimages = [") + images + "]\nreport = \"" + report +
                              "\"\ncheckpoint = 1e-9"});
}

/// A cone that turns and flows apart.
const std::string apart = small(velocity_of({"0.3*x - y", "0.3*y + x"}), "", "none");

/// With pictures and a page.
const std::string drawn = small(velocity_of({"0.3*x - y", "0.3*y + x"}), draws_pictures ? "\"heatmap\"" : "",
                                draws_pictures ? "html" : "none");

constexpr int killed = 128 + 9;  // as the shell tells it

/// How many faults a test makes: GAUSSDRIFT_FAULTS, else `usual`.
long faults_of_a_test(long usual) {
  const char* text = std::getenv("GAUSSDRIFT_FAULTS");
  return text ? std::max(1L, std::atol(text)) : usual;
}

/// At most `count` of the numbers from 1 to `most`, spread evenly.
std::vector<long> spread(long most, long count) {
  count = std::min(most, count);
  std::vector<long> numbers;
  for (long i = 0; i < count; ++i) numbers.push_back(1 + (2 * i + 1) * most / (2 * count));
  return numbers;
}

/// Nothing wrong: "".
std::string wrong_xml(const std::string& text) {
  XML_Parser parser = XML_ParserCreate(nullptr);
  const bool parses = XML_Parse(parser, text.data(), static_cast<int>(text.size()), 1) == XML_STATUS_OK;
  const std::string wrong = parses ? "" : XML_ErrorString(XML_GetErrorCode(parser));
  XML_ParserFree(parser);
  return wrong;
}

std::string wrong_json(const std::string& text) { return nlohmann::json::accept(text) ? "" : "it is no JSON"; }

/// Rows end with a line end, and each has as many columns as the heading.
std::string wrong_table(const std::string& text) {
  if (text.empty() || text.back() != '\n') return "its last row is cut short";
  std::istringstream rows(text);
  std::string row;
  std::getline(rows, row);
  const auto columns = std::count(row.begin(), row.end(), ',');
  while (std::getline(rows, row))
    if (std::count(row.begin(), row.end(), ',') != columns) return "a row has not all columns";
  return "";
}

std::uint32_t big_endian(const std::string& text, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<unsigned char>(text[at + i]);
  return number;
}

/// Every piece of a PNG has a check sum, and the last is called IEND.
std::string wrong_png(const std::string& text) {
  if (!text.starts_with("\x89PNG\r\n\x1a\n")) return "it is no PNG";
  for (std::size_t at = 8; at + 12 <= text.size();) {
    const std::size_t length = big_endian(text, at);
    if (at + 12 + length > text.size()) return "it is cut short";
    const auto* piece = reinterpret_cast<const Bytef*>(text.data()) + at + 4;
    if (crc32_z(0, piece, length + 4) != big_endian(text, at + 8 + length)) return "a check sum is wrong";
    if (text.compare(at + 4, 4, "IEND") == 0) return at + 12 + length == text.size() ? "" : "something follows its end";
    at += 12 + length;
  }
  return "it has no end";
}

std::string wrong_text(const std::string& text) { return text.ends_with('\n') ? "" : "its last line is cut short"; }

std::string wrong_page(const std::string& text) {
  return text.ends_with("</html>\n") || text.ends_with("</html>") ? "" : "it is cut short";
}

/// What cannot be read in the folder of a run, a line each. Files with a point ahead are none of the run's.
std::string unreadable_in(const fs::path& folder) {
  static const std::map<std::string, std::string (*)(const std::string&)> by_ending{
      {".vti", wrong_xml}, {".vtp", wrong_xml},  {".pvd", wrong_xml},   {".json", wrong_json}, {".csv", wrong_table},
      {".png", wrong_png}, {".txt", wrong_text}, {".toml", wrong_text}, {".py", wrong_text},   {".html", wrong_page}};
  std::string list;
  if (!fs::exists(folder)) return list;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const auto wrong = by_ending.find(entry.path().extension().string());
    if (!entry.is_regular_file() || entry.path().filename().string().starts_with(".") || wrong == by_ending.end())
      continue;
    const std::string why = wrong->second(read_file(entry.path()));
    if (!why.empty()) list += entry.path().string() + ": " + why + "\n";
  }
  return list;
}

/// Hidden files that a process left.
std::string left_over_in(const fs::path& folder) {
  std::string list;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().filename().string().starts_with(".")) list += entry.path().filename().string() + " ";
  return list;
}

struct Counts {
  long calls = 0, allocations = 0;
};

class Faults : public testing::Test {
 protected:
  /// Runs it once without a fault: what the others are compared with, and how many calls there are.
  Counts begin(const std::string& text, const std::string& counted = "") {
    write_file(folder / "small.toml", text);
    const Outcome whole = call(run_part, counted);
    EXPECT_EQ(whole.exit_code, 0) << whole.err;
    fs::rename(folder / "part", folder / "whole");
    Counts counts;
    std::istringstream report(read_file(folder / "report.txt"));
    std::string word;
    report >> word >> counts.calls >> word >> counts.allocations;
    EXPECT_GT(counts.calls, 100) << "the library that makes faults was not there";
    EXPECT_GT(counts.allocations, 100);
    return counts;
  }

  Outcome call(const std::string& arguments, const std::string& faults = "") {
    fs::remove(folder / "report.txt");
    return gaussdrift_in(folder, arguments + " --threads 1",
                         "OMP_WAIT_POLICY=passive LD_PRELOAD='" FAULTS_LIBRARY "' FAULTS_FOLDER='" +
                             (fs::canonical(folder.path()) / "part").string() + "' FAULTS_REPORT='" +
                             (folder / "report.txt").string() + "' " + faults);
  }

  /// One fault in a new run, and all that is promised after it.
  void suffer(const std::string& faults, const std::set<int>& documented) {
    const Outcome outcome = call(run_part, faults);
    const std::string report = read_file(folder / "report.txt");
    SCOPED_TRACE(faults + ", which " + report.substr(0, report.find('\n')));
    ++exits_[outcome.exit_code];
    EXPECT_TRUE(report.starts_with("struck")) << "no fault was made";
    EXPECT_TRUE(documented.contains(outcome.exit_code)) << outcome.exit_code << "\n" << outcome.out << outcome.err;
    const std::string unreadable = unreadable_in(folder / "part");
    EXPECT_EQ(unreadable, "");
    unreadable_ += std::count(unreadable.begin(), unreadable.end(), '\n');
    go_on(outcome);
    fs::remove_all(folder / "part");
  }

  void go_on(const Outcome& before) {
    const bool can = fs::exists(folder / "part/run.toml");
    const Outcome again = call(can ? "resume part" : run_part + " --force");
    resumed_ += can;
    ASSERT_EQ(again.exit_code, 0) << before.err << again.err;
    if (before.err.find("gaussdrift report part makes it later") != std::string::npos) {
      const Outcome page = gaussdrift_in(folder, "report part");
      EXPECT_EQ(page.exit_code, 0) << page.err;
    }
    EXPECT_EQ(unreadable_in(folder / "part"), "");
    // A complete run is not written again, so a hidden file that could not be removed stays until somebody writes there.
    if (again.out.find("is complete") == std::string::npos) {
      EXPECT_EQ(left_over_in(folder / "part"), "");
    }
    EXPECT_EQ(left_over_in(folder / "whole"), "");
    expect_same(folder / "whole", folder / "part");
    const auto whole = status_of("whole"), part = status_of("part");
    for (const char* member : {"state", "outputs", "last_output", "files"})
      EXPECT_EQ(whole.at(member), part.at(member)) << member;
  }

  nlohmann::json status_of(const char* run) const {
    return nlohmann::json::parse(read_file(folder / run / "status.json"), nullptr, false);
  }

  /// One line: what was made, and how it ended.
  void tell(const std::string& what, long of) {
    long made = 0;
    std::string ends;
    for (const auto& [code, times] : exits_) {
      made += times;
      ends += (ends.empty() ? "" : ", ") + std::to_string(times) + " with " + std::to_string(code);
    }
    std::cout << "faults: " << made << " of " << of << " " << what << "; exits: " << ends << "; " << resumed_
              << " resumed, " << made - resumed_ << " begun again; unreadable files: " << unreadable_ << std::endl;
  }

  const ScratchFolder folder;
  const std::string run_part = "run small.toml --out part";

 private:
  std::map<int, long> exits_;
  long resumed_ = 0, unreadable_ = 0;
};

/// The program may go on to its end (0) where nothing is lost.
const std::set<int> of_files{0, 6};

TEST_F(Faults, ACallThatFindsTheDiskFull) {
  const long calls = begin(apart).calls;
  for (const long at : spread(calls, faults_of_a_test(60)))
    suffer("FAULTS_ERROR=" + std::to_string(ENOSPC) + " FAULTS_AT=" + std::to_string(at), of_files);
  tell("calls found the disk full", calls);
}

TEST_F(Faults, ADiskThatStaysFull) {
  const long calls = begin(apart).calls;
  for (const long at : spread(calls, faults_of_a_test(40)))
    suffer("FAULTS_LASTING=1 FAULTS_ERROR=" + std::to_string(ENOSPC) + " FAULTS_AT=" + std::to_string(at), of_files);
  tell("calls found the disk full, and so did all later ones", calls);
}

TEST_F(Faults, ACallThatFailsWithAnErrorOfTheDisk) {
  const long calls = begin(apart).calls;
  for (const long at : spread(calls, faults_of_a_test(60)))
    suffer("FAULTS_ERROR=" + std::to_string(EIO) + " FAULTS_AT=" + std::to_string(at), of_files);
  tell("calls failed with an error of the disk", calls);
}

TEST_F(Faults, AKill) {
  const long calls = begin(drawn).calls;
  for (const long at : spread(calls, faults_of_a_test(20)))
    suffer("FAULTS_ERROR=kill FAULTS_AT=" + std::to_string(at), {killed});
  tell("calls killed a run with pictures and a page", calls);
}

/// Once the program writes.
TEST_F(Faults, AnAllocationThatFails) {
  const long allocations = begin(apart).allocations;
  for (const long at : spread(allocations, faults_of_a_test(40)))
    suffer("FAULTS_NEW_AT=" + std::to_string(at), {0, 3, 6});
  tell("allocations failed", allocations);
}

/// From its start. This fails at some of them, probably because of g++ 12: where an allocation fails inside the braces of a table of keys,
/// it destroys the strings before it twice, and the program aborts. It has written nothing then.
TEST_F(Faults, DISABLED_AnAllocationThatFailsFromTheStart) {
  const long allocations = begin(apart, "FAULTS_NEW_ALL=1").allocations;
  for (const long at : spread(allocations, faults_of_a_test(300)))
    suffer("FAULTS_NEW_ALL=1 FAULTS_NEW_AT=" + std::to_string(at), {0, 3, 6});
  tell("allocations failed, from the start of the program", allocations);
}

}  // namespace
}  // namespace gaussdrift
