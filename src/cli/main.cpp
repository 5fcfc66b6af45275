// The program gaussdrift.
#include <csignal>

#include "cli/verbs.hpp"

int main(int argc, char** argv) {
#ifdef SIGXFSZ
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is then an error that can be reported, not the end
#endif
  return gaussdrift::cli::main_verbs(argc, argv);
}
