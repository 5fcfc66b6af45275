// The program gaussdrift.
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "cli/waiting_threads.hpp"

int main(int argc, char** argv) {
  gaussdrift::cli::let_waiting_threads_sleep(argv);
  gaussdrift::cli::prepare_streams();
  return gaussdrift::cli::main_verbs(argc, argv);
}
