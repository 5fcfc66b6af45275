// The program gaussdrift.
#include "cli/verbs.hpp"

int main(int argc, char** argv) { return gaussdrift::cli::main_verbs(argc, argv); }
