#include "cli/terminal.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>

namespace gaussdrift::cli {

void prepare_streams() {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(number, F_GETFD) == -1 && errno == EBADF)
      // The lowest free number, so this very one. For reading: what is said there fails, as it did before.
      if (::open("/dev/null", O_RDONLY) < 0) ::open("/", O_RDONLY);
  std::signal(SIGPIPE, SIG_IGN);
#ifdef SIGXFSZ
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is then an error that can be reported, not the end
#endif
}

void put(std::FILE* stream, std::string_view text) { std::fwrite(text.data(), 1, text.size(), stream); }

std::size_t columns_of(std::FILE* stream) {
  const int number = ::fileno(stream);
  if (::isatty(number) == 0) return 0;
  if (const char* told = std::getenv("COLUMNS"); told && *told) return std::strtoul(told, nullptr, 10);
  winsize size{};
  return ::ioctl(number, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

Delivery delivery() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return Delivery::all;
  pollfd reader{.fd = STDOUT_FILENO, .events = POLLOUT, .revents = 0};
  const bool gone = ::poll(&reader, 1, 0) == 1 && (reader.revents & POLLERR) != 0;
  return gone ? Delivery::reader_gone : Delivery::lost;
}

}  // namespace gaussdrift::cli
