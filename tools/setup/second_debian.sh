# Sourced by what needs a Debian beside the machine's own: a bare one in the folder $root, and commands in it. Needs root and debootstrap.

fail() { echo "$1" >&2; exit 1; }

needs_for_second_debian() {
  [[ $(id -u) = 0 ]] || fail "only root can make a second Debian"
  command -v debootstrap >/dev/null || fail "there is no debootstrap: apt-get install debootstrap"
}

in_root() {
  chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} "$@"
}

# From the mirror that this machine uses, with this machine's ways to it.
make_second_debian() {
  local mirror
  mirror=$(apt-get indextargets --format '$(REPO_URI) $(ORIGIN)' | awk '$2 == "Debian" && !m {m = $1} END {print m}')
  mkdir -p "$root" && chmod 755 "$root" &&  # mktemp makes it for root alone
    debootstrap --variant=minbase --include=ca-certificates bookworm "$root" "${mirror:-http://deb.debian.org/debian}" &&
    cp /etc/resolv.conf "$root/etc/resolv.conf" &&
    { grep -lrs 'Acquire::' /etc/apt/apt.conf.d | xargs -r cp -t "$root/etc/apt/apt.conf.d"; } &&
    in_root apt-get update
}
