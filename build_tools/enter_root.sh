# SPDX-License-Identifier: GPL-3.0-or-later
# enter_root.sh ROOT PROJECT COMMAND…: runs a command in the Debian system in the folder ROOT, the project read-only
# at /project. To be called by `unshare --mount`: then the mounts end with the command.
set -e
root=$1 project=$2
shift 2
mount --rbind /proc "$root/proc"
mount --rbind /dev "$root/dev"
mount --bind -o ro "$project" "$root/project"
exec chroot "$root" "$@"
