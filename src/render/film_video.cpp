// MP4 and WebM by ffmpeg, which is another program: it gets the pixels through a pipe and writes the file that was opened.
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "gaussdrift/error.hpp"
#include "render/film.hpp"

extern char** environ;

namespace gaussdrift::render {

namespace {

/// The first of its name in the folders of PATH; empty: there is none.
std::string ffmpeg() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string program = (folder.empty() ? "." : folder) + "/ffmpeg";
    if (access(program.c_str(), X_OK) == 0) return program;
  }
  return "";
}

std::string missing_ffmpeg() {
  return ffmpeg().empty() ? "ffmpeg is not installed (Debian: apt-get install ffmpeg)" : "";
}

/// Open files that are closed with it.
struct Descriptor {
  int number = -1;
  ~Descriptor() { close_now(); }
  void close_now() {
    if (number >= 0) close(number);
    number = -1;
  }
};

/// The program with its input and its words.
class Encoder {
 public:
  Encoder(std::vector<std::string> arguments, int output) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category());
    Descriptor from{ends[0]};
    to_.number = ends[1];
    words_ = std::tmpfile();
    if (!words_) throw std::system_error(errno, std::generic_category());
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    // First the file: its number may be one of the others.
    posix_spawn_file_actions_adddup2(&actions, output, output_number);
    posix_spawn_file_actions_adddup2(&actions, from.number, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(words_), STDERR_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    const int problem = posix_spawn(&process_, words[0], &actions, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (problem != 0) {
      std::fclose(words_);
      throw std::system_error(problem, std::generic_category());
    }
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  ~Encoder() {
    if (process_ > 0) {  // something was thrown
      kill(process_, SIGKILL);
      to_.close_now();
      waitpid(process_, nullptr, 0);
    }
    std::fclose(words_);
  }

  /// False where it takes no more.
  bool put(const void* bytes, std::size_t count) {
    const char* from = static_cast<const char*>(bytes);
    while (count > 0) {
      const ssize_t done = ::write(to_.number, from, count);
      if (done < 0 && errno == EINTR) continue;
      if (done < 0 && errno == EPIPE) return false;
      if (done < 0) throw std::system_error(errno, std::generic_category());
      from += done, count -= static_cast<std::size_t>(done);
    }
    return true;
  }

  /// Throws FileError with what the program says, if it failed.
  void finish() {
    to_.close_now();
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = 0;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    std::rewind(words_);
    std::string said;
    for (int letter = 0; said.size() < 400 && (letter = std::fgetc(words_)) != EOF;)
      said += letter == '\n' ? ' ' : static_cast<char>(letter);
    throw FileError(fmt::format("ffmpeg {}: {}",
                                WIFSIGNALED(status) ? fmt::format("was ended by signal {}", WTERMSIG(status))
                                                    : fmt::format("ended with exit code {}", WEXITSTATUS(status)),
                                said.empty() ? "it says nothing" : said));
  }

  static constexpr int output_number = 3;

 private:
  Descriptor to_;
  std::FILE* words_ = nullptr;
  pid_t process_ = 0;
};

/// Numbers of threads change what the coders write, so theirs is fixed.
void encode(const Reel& reel, std::FILE* file, const std::vector<std::string>& coder) {
  const std::string program = ffmpeg();
  if (program.empty()) throw FileError(missing_ffmpeg());
  std::vector<std::string> arguments{program,
                                     "-loglevel",
                                     "error",
                                     "-nostdin",
                                     "-y",
                                     "-f",
                                     "rawvideo",
                                     "-pix_fmt",
                                     "rgb24",
                                     "-s",
                                     fmt::format("{}x{}", reel.width, reel.height),
                                     "-framerate",
                                     fmt::format("{}/{}", reel.frames * 1000, std::lround(reel.seconds * 1000)),
                                     "-i",
                                     "pipe:0",
                                     "-threads",
                                     "2",
                                     "-pix_fmt",
                                     "yuv420p",
                                     "-fflags",
                                     "+bitexact",
                                     "-flags",
                                     "+bitexact"};
  arguments.insert(arguments.end(), coder.begin(), coder.end());
  arguments.push_back(fmt::format("/dev/fd/{}", Encoder::output_number));
  Encoder encoder(std::move(arguments), fileno(file));
  bool takes = true;
  for (std::size_t i = 0; takes && i < reel.frames; ++i) {
    const Image frame = reel.frame(i);
    for (int y = frame.height - 1; takes && y >= 0; --y)
      takes = encoder.put(frame.pixels.data() + static_cast<std::ptrdiff_t>(y) * frame.width,
                          sizeof(Colour) * static_cast<std::size_t>(frame.width));
  }
  encoder.finish();
  std::fseek(file, 0, SEEK_END);
}

void write_mp4(const Reel& reel, std::FILE* file) {
  encode(reel, file, {"-c:v", "libx264", "-crf", "18", "-preset", "medium", "-movflags", "+faststart", "-f", "mp4"});
}

void write_webm(const Reel& reel, std::FILE* file) {
  encode(reel, file, {"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "0", "-cpu-used", "4", "-f", "webm"});
}

}  // namespace

FilmKind mp4_film() {
  return {.about = {.name = "mp4", .meaning = "a video (H.264) by ffmpeg, which slides and telephones play"},
          .size = {1280, 960},
          .bytes_of_pixel = 0.02,
          .missing = missing_ffmpeg,
          .write = write_mp4};
}

FilmKind webm_film() {
  return {.about = {.name = "webm", .meaning = "a video (VP9) by ffmpeg, which browsers play"},
          .size = {1280, 960},
          .bytes_of_pixel = 0.02,
          .missing = missing_ffmpeg,
          .write = write_webm};
}

}  // namespace gaussdrift::render
