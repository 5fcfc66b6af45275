// Calls the program as a user does, and keeps what it said.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace gaussdrift {

namespace fs = std::filesystem;

inline std::string read_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

inline void write_file(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

/// A folder of its own for one test, removed at the end.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = (fs::temp_directory_path() / "gaussdrift-test.XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no scratch folder");
    path_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  fs::path operator/(const std::string& name) const { return path_ / name; }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

struct Outcome {
  int exit_code = -1;
  std::string out, err;
};

/// `before` is shell text ahead of the call: limits, environment.
inline Outcome gaussdrift_in(const ScratchFolder& folder, const std::string& arguments,
                             const std::string& before = "") {
  const fs::path out = folder / "stdout.txt", err = folder / "stderr.txt";
  const std::string command = "cd '" + folder.path().string() + "' && { " + before + " '" PROGRAM "' " + arguments +
                              "; } >'" + out.string() + "' 2>'" + err.string() + "' </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), read_file(out), read_file(err)};
}

/// A cone that turns once, small enough for a test: a few hundredths of a second.
inline const std::string small_case = R"(gaussdrift = 1

[domain]
min = [-1, -1]
max = [ 1,  1]

[velocity]
u = ["-y", "x"]

[density]
shape  = "wendland"
center = [0.5, 0]
radius = 0.25

[particles]
per_axis = 60

[time]
end  = "2*pi"
step = 0.05

[evaluate]
per_axis = 40

[output]
times  = [0, "pi", "2*pi"]
images = []
)";

}  // namespace gaussdrift
