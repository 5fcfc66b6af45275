// The verbs of the program: each takes what the command line said and returns an exit code or throws an Error.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace gaussdrift::cli {

/// Options that every verb with a case understands.
struct CaseOptions {
  std::filesystem::path file;
  std::vector<std::string> overrides;  // --set key=value
  int threads = 0;                     // 0: all
  bool json = false;                   // results as JSON on stdout
};

struct RunOptions {
  CaseOptions scene;
  std::filesystem::path folder;  // --out; empty: output/<case name>
  bool force = false;
};

ExitCode run(const RunOptions& options);
ExitCode check(const CaseOptions& options);
/// `table` is empty to list what can be reproduced.
ExitCode reproduce(const std::string& table, int threads, bool json);

/// Parses the command line, does what it says, prints errors on stderr; returns the exit code.
int main_verbs(int argc, char** argv);

}  // namespace gaussdrift::cli
