/// @file
/// Errors by what the caller can do about them.
#pragma once

#include <stdexcept>
#include <string>

namespace gaussdrift {

/// How the program ends; docs/usage.md, "Exit codes".
enum class ExitCode {
  ok = 0,             ///< all is well
  internal = 1,       ///< a fault of the program
  command_line = 2,   ///< the command line is wrong
  input = 3,          ///< a case or its data are wrong, or it does not fit into memory
  numerical = 4,      ///< a value is not finite, or an error bound cannot be kept
  check = 5,          ///< a [[check]] failed
  files = 6,          ///< a file could not be read or written
  stopped = 7,        ///< --stop-after: the run is not complete, `resume` goes on
  hung_up = 129,      ///< SIGHUP stopped the run, `resume` goes on
  interrupted = 130,  ///< SIGINT (Ctrl-C), likewise
  terminated = 143    ///< SIGTERM, likewise
};

/// Base of every error whose message is meant for the user.
class Error : public std::runtime_error {
 public:
  /// `message`: whole sentences, with the remedy where there is one.
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  /// How the program would end.
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// The command line asks for something that does not exist or contradicts itself.
class CommandLineError : public Error {
 public:
  /// See Error.
  explicit CommandLineError(const std::string& message) : Error(ExitCode::command_line, message) {}
};

/// A case file, a table or a number in it is invalid; the message names place, rule and remedy.
class InputError : public Error {
 public:
  /// See Error.
  explicit InputError(const std::string& message) : Error(ExitCode::input, message) {}
};

/// The run met a value that is not finite; the message names step, time, particle and place.
class NumericalError : public Error {
 public:
  /// See Error.
  explicit NumericalError(const std::string& message) : Error(ExitCode::numerical, message) {}
};

/// A file or folder exists already, cannot be read, or cannot be written.
class FileError : public Error {
 public:
  /// See Error.
  explicit FileError(const std::string& message) : Error(ExitCode::files, message) {}
};

}  // namespace gaussdrift
