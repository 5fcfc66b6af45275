// The memory and disk space of a run, estimated from its numbers alone, and the memory of this machine.
#pragma once

#include <cstddef>

#include "gaussdrift/case.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::accuracy {

using write::Extent;

/// Bytes that a run takes beyond those of the program and the data of the case: the most of its stages. Measured over
/// the cases and sizes of tests/program/footprint_test.cpp: right within a factor of 1.3 for what is above 20 MB.
double memory_of_run(const Case& spec, const Extent& extent);

/// Bytes of all files of a run.
double disk_of_run(const Case& spec, const Extent& extent);

/// Bytes that this process holds, or has held.
double memory_of_this_process();

/// Bytes that a process may hold here: of the machine, or of the limits that are set for it.
double memory_of_this_machine();

}  // namespace gaussdrift::accuracy
