/* Ahead of libmpi: says that MPI is started, and ends the program. */
#include <stdlib.h>
#include <unistd.h>

int MPI_Init_thread(int* argc, char*** argv, int required, int* provided) {
  static const char words[] = "MPI is started\n";
  (void)argc, (void)argv, (void)required, (void)provided;
  if (write(2, words, sizeof words - 1) < 0) _exit(98);
  _exit(99);
}
