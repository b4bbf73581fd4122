# SPDX-License-Identifier: GPL-3.0-or-later
# enter_root.sh ROOT PROJECT CCACHE COMMAND…: runs a command in the Debian system in the folder ROOT, the project
# read-only at /project, ccache's files in the folder CCACHE. To be called by `unshare --mount`: then the mounts end
# with the command.
set -e
root=$1 project=$2 ccache=$3
shift 3
mount --rbind /proc "$root/proc"
mount --rbind /dev "$root/dev"
mount --bind -o ro "$project" "$root/project"
mkdir -p "$root/root/.cache/ccache"
mount --bind "$ccache" "$root/root/.cache/ccache"
exec chroot "$root" "$@"
