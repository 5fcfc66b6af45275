// Calls the program as a user does, and keeps what it said.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "case_text.hpp"
#include "pictures.hpp"
#include "scratch_folder.hpp"

namespace gaussdrift {

namespace fs = std::filesystem;

struct Outcome {
  int exit_code = -1;
  std::string out, err;
};

/// Of a command of the shell, called in the folder.
inline Outcome outcome_of(const ScratchFolder& folder, const std::string& command) {
  const fs::path out = folder / "stdout.txt", err = folder / "stderr.txt";
  const std::string call = "cd '" + folder.path().string() + "' && { " + command + "; } >'" + out.string() + "' 2>'" +
                           err.string() + "' </dev/null";
  const int status = std::system(call.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), read_file(out), read_file(err)};
}

/// `before` is shell text ahead of the call: limits, environment.
inline Outcome gaussdrift_in(const ScratchFolder& folder, const std::string& arguments,
                             const std::string& before = "") {
  return outcome_of(folder, before + " '" PROGRAM "' " + arguments);
}

/// A cone that turns once, small enough for a test: a few hundredths of a second.
inline const std::string small_case = case_text({.density = shape_of("wendland", "0.5, 0", "0.25"),
                                                 .particles = "per_axis = 60",
                                                 .time = "end = \"2*pi\"\nstep = 0.05",
                                                 .evaluate = "per_axis = 40",
                                                 .output = R"(times = [0, "pi", "2*pi"]
images = [])"});

}  // namespace gaussdrift
