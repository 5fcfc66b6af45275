// The program gaussdrift.
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "cli/waiting_threads.hpp"

int main(int argc, char** argv) {
  gaussdrift::cli::prepare_threads(argv);
  gaussdrift::cli::prepare_streams();
  return gaussdrift::cli::main_verbs(argc, argv);
}
