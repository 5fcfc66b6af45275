// Two hosts on this machine: two network namespaces with a wire between them, each with a host name. Processes see the same
// files and each other's numbers, but reach each other by TCP alone. Needs root and `ip netns`.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "ranks/disturbed_ranks.hpp"

namespace gaussdrift {

class TwoHosts {
 public:
  TwoHosts() {
    if (::geteuid() != 0) {
      why_not_ = "only root can make two hosts of one machine";
      return;
    }
    if (!quiet("ip netns list && unshare --uts true")) {
      why_not_ = "this machine has no `ip netns` or no `unshare`";
      return;
    }
    remove_stale();
    if (!quiet("ip netns add " + a_ + " && ip netns add " + b_ + " && ip link add " + wire_a_ + " netns " + a_ +
               " type veth peer name " + wire_b_ + " netns " + b_ + " && ip -n " + a_ + " addr add 10.77.0.1/24 dev " +
               wire_a_ + " && ip -n " + b_ + " addr add 10.77.0.2/24 dev " + wire_b_ + " && ip -n " + a_ +
               " link set lo up && ip -n " + b_ + " link set lo up && ip -n " + a_ + " link set " + wire_a_ +
               " up && ip -n " + b_ + " link set " + wire_b_ + " up"))
      why_not_ = "this machine lets nobody make network namespaces";
  }
  ~TwoHosts() {
    if (::geteuid() == 0) remove(a_), remove(b_);
  }
  TwoHosts(const TwoHosts&) = delete;
  TwoHosts& operator=(const TwoHosts&) = delete;

  /// Empty: there are two.
  const std::string& why_not() const { return why_not_; }

  /// A command that starts `command` on two ranks of each host, rank 0 and 1 on host a.
  std::string on_both(const ScratchFolder& folder, const std::string& command, const std::string& options = "") const {
    // What stands for ssh: agent.sh [options] HOST COMMAND...
    write_file(folder / "agent.sh", "#!/bin/sh\nwhile [ \"${1#-}\" != \"$1\" ]; do shift; done\nshift\n" + inside(b_) +
                                        " 'hostname gaussdrift-b; exec sh -c \"$0\"' \"$*\"\n");
    fs::permissions(folder / "agent.sh", fs::perms::owner_all);
    write_file(folder / "start.sh",
               "hostname gaussdrift-a\nexec " + mpirun +
                   "--host 10.77.0.1:2,10.77.0.2:2 --mca plm rsh --mca plm_rsh_agent ./agent.sh "
                   "--mca oob_tcp_if_include 10.77.0.0/24 --mca btl_tcp_if_include 10.77.0.0/24 --mca btl tcp,self "
                   "--oversubscribe --bind-to none " +
                   options + " " + command + "\n");
    return inside(a_) + " '. ./start.sh'";
  }

  std::string cut_the_wire() const { return "ip -n " + a_ + " link set " + wire_a_ + " down"; }

 private:
  static bool quiet(const std::string& command) {
    return std::system(("{ " + command + "; } >/dev/null 2>&1").c_str()) == 0;
  }
  static std::string inside(const std::string& name) { return "exec ip netns exec " + name + " unshare --uts sh -c"; }
  /// With all processes in it.
  static void remove(const std::string& name) {
    quiet("for process in $(ip netns pids " + name + "); do kill -9 $process; done; ip netns del " + name);
  }
  /// Of tests that were killed: the names end in the number of their process.
  static void remove_stale() {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator("/run/netns", ignored)) {
      const std::string name = entry.path().filename().string();
      if (!name.starts_with("gaussdrift-a-") && !name.starts_with("gaussdrift-b-")) continue;
      const int process = std::atoi(name.c_str() + 13);
      if (process > 0 && ::kill(process, 0) != 0) remove(name);
    }
  }

  const std::string number_ = std::to_string(::getpid());
  const std::string a_ = "gaussdrift-a-" + number_, b_ = "gaussdrift-b-" + number_;
  const std::string wire_a_ = "gda" + number_, wire_b_ = "gdb" + number_;
  std::string why_not_;
};

}  // namespace gaussdrift
