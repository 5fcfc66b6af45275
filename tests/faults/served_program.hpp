// The program, loaded once: each call begins in a copy of that process (FAULTS_SERVE in faults/preloaded/faults.cpp).
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "program/program.hpp"

namespace gaussdrift {

class ServedProgram {
 public:
  ServedProgram() {
    std::array<int, 2> to{}, from{};
    if (pipe(to.data()) != 0 || pipe(from.data()) != 0) throw std::runtime_error("there is no pipe");
    const std::string drawing = std::filesystem::path(PROGRAM).parent_path() / "libgaussdrift_drawing.so";
    child_ = fork();
    if (child_ == 0) {
      dup2(to[0], 0), dup2(from[1], 1);
      for (const int end : {to[0], to[1], from[0], from[1]}) close(end);
      setenv("LD_PRELOAD", FAULTS_LIBRARY, 1), setenv("FAULTS_SERVE", drawing.c_str(), 1),
          setenv("OMP_WAIT_POLICY", "passive", 1);
      execl(PROGRAM, PROGRAM, nullptr);
      _exit(99);
    }
    close(to[0]), close(from[1]);
    to_ = fdopen(to[1], "w"), from_ = fdopen(from[0], "r");
  }
  ~ServedProgram() {
    std::fclose(to_), std::fclose(from_);
    waitpid(child_, nullptr, 0);
  }
  ServedProgram(const ServedProgram&) = delete;
  ServedProgram& operator=(const ServedProgram&) = delete;

  /// In the folder. `variables` and `arguments` as the shell reads them.
  Outcome call(const ScratchFolder& folder, const std::string& variables, const std::string& arguments) {
    const std::string request = folder.path().string() + "\t" + variables + "\t'" PROGRAM "' " + arguments + "\n";
    std::fputs(request.c_str(), to_);
    std::fflush(to_);
    int code = -1;
    if (std::fscanf(from_, "%d", &code) != 1) throw std::runtime_error("the program does not answer");
    return {code, read_file(folder / "stdout.txt"), read_file(folder / "stderr.txt")};
  }

 private:
  pid_t child_ = 0;
  std::FILE *to_ = nullptr, *from_ = nullptr;
};

}  // namespace gaussdrift
