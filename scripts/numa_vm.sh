#!/bin/bash
# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#
# Runs a mapfile of `platform: machine` on this checkout in a virtual machine with two NUMA nodes
# of two CPUs, in software emulation, which takes minutes. Shows what was bound where, and fails
# if a receive thread is not on its cluster's first CPU, or a segment not in its cluster's node.
# Needs Debian and: apt-get install qemu-system-x86 busybox-static cpio e2fsprogs
set -euo pipefail
cd "$(dirname "$0")/.."
CHECKOUT=$PWD
WORK=$CHECKOUT/build/numa
ROOT=$WORK/root
LIBRARIES=/usr/lib/x86_64-linux-gnu
rm -rf "$WORK"
mkdir -p "$ROOT"/{proc,sys,dev,tmp,run,root,etc,usr/bin,"$LIBRARIES"} "$WORK/first"/{bin,dev,root}

get_kernel() {
  local package
  package=$(apt-cache depends linux-image-cloud-amd64 | awk '/Depends/ {print $2}')
  (cd "$WORK" && apt-get -qq -o APT::Sandbox::User=root download "$package")
  dpkg -x "$WORK"/linux-image-*.deb "$WORK/kernel"
}

# The disk has what `manycore run` needs of this machine, under the same paths.
make_disk() {
  ln -s usr/bin usr/lib usr/lib64 "$ROOT"
  cp -a /usr/lib64 "$ROOT/usr"
  cp -a /etc/{passwd,group,ld.so.cache} "$ROOT/etc"
  find "$LIBRARIES" -maxdepth 1 -name '*.so*' -size -6M -exec cp -a -t "$ROOT$LIBRARIES" {} +
  cp -a /usr/lib/python3* "$ROOT/usr/lib"
  cp -a /usr/bin/{python3*,busybox} "$ROOT/usr/bin"
  for tool in sh mount mkdir cat grep sleep kill poweroff; do
    ln -s busybox "$ROOT/usr/bin/$tool"
  done
  mkdir -p "$ROOT$CHECKOUT"
  tar -c --exclude-from=- .venv rmw_manycore_py startup mapfiles <<'END' |
*/site-packages/open3d
*/site-packages/clang_tidy
*/site-packages/cmake
*/site-packages/ortools
*/site-packages/pandas
__pycache__
END
    tar -x -C "$ROOT$CHECKOUT"
  cp "$WORK/init" "$WORK/check.sh" "$ROOT"
  mke2fs -q -t ext4 -d "$ROOT" "$WORK/disk" 2G
}

# The first file system loads the modules that the disk needs.
make_first() {
  local drivers=("$WORK"/kernel/lib/modules/*/kernel/drivers)
  local modules=(virtio_ring virtio virtio_pci_{legacy_dev,modern_dev} virtio_pci virtio_blk)
  for module in "${modules[@]}"; do cp "${drivers[0]}"/*/"$module.ko" "$WORK/first"; done
  cp /usr/bin/busybox "$WORK/first/bin"
  cat >"$WORK/first/init" <<END
#!/bin/busybox sh
/bin/busybox mount -t devtmpfs dev /dev
for module in ${modules[*]}; do /bin/busybox insmod /\$module.ko; done
while [ ! -e /dev/vda ]; do /bin/busybox sleep 1; done
/bin/busybox mount -o ro -t ext4 /dev/vda /root
exec /bin/busybox switch_root /root /init
END
  chmod +x "$WORK/first/init"
  (cd "$WORK/first" && find . | cpio -o -H newc --quiet) | gzip >"$WORK/first.gz"
}

write_guest() {
  cat >"$WORK/init" <<END
#!/usr/bin/busybox sh
export PATH=$CHECKOUT/.venv/bin:/usr/bin HOME=/root
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t devtmpfs dev /dev
mkdir -p /dev/shm
for place in /dev/shm /tmp /run /root; do mount -t tmpfs memory \$place; done
cd /tmp
sh /check.sh
poweroff -f
END
  chmod +x "$WORK/init"
  cat >"$WORK/check.sh" <<'END'
cat >map.yaml <<'MAP'
platform: machine
nodes:
  talker: {cluster: 1, package: rmw_manycore, executable: talker}
  listener: {cluster: 2, package: rmw_manycore, executable: listener}
MAP
manycore map show map.yaml
manycore doctor
manycore run map.yaml --duration 60 >run.log 2>&1 &
while kill -0 $! && ! grep "I heard: .*3" run.log; do sleep 1; done
for process in /proc/[0-9]*; do
  name=$(cat $process/comm)
  grep -q /cluster- $process/numa_maps 2>/dev/null || continue
  echo "$name: CPU $(grep -o 'Cpus_allowed_list.*' $process/status)"
  grep /cluster- $process/numa_maps
done
END
}

get_kernel
write_guest
make_disk
make_first
timeout 1800 qemu-system-x86_64 -accel tcg,thread=multi -machine q35 -cpu max -m 1536 \
  -smp 4,sockets=2,cores=2 -object memory-backend-ram,id=m0,size=768M \
  -object memory-backend-ram,id=m1,size=768M -numa node,nodeid=0,cpus=0-1,memdev=m0 \
  -numa node,nodeid=1,cpus=2-3,memdev=m1 -kernel "$WORK"/kernel/boot/vmlinuz-* \
  -initrd "$WORK/first.gz" -append "console=ttyS0 quiet panic=1" \
  -drive file="$WORK/disk",format=raw,if=virtio,readonly=on \
  -nographic -no-reboot -nodefaults -serial stdio </dev/null | tr -d '\r' | tee "$WORK/log"

grep -q "manycore_rt_1: CPU Cpus_allowed_list:.0$" "$WORK/log"
grep -q "manycore_rt_2: CPU Cpus_allowed_list:.2$" "$WORK/log"
grep -q "prefer:0 .*/cluster-1 .* N0=" "$WORK/log"
grep -q "prefer:1 .*/cluster-2 .* N1=" "$WORK/log"
if grep "/cluster-1 .* N1=\|/cluster-2 .* N0=" "$WORK/log"; then
  echo "pages of a segment are in the other node" >&2
  exit 1
fi
echo "each cluster's receive thread and segment are where they belong"
