#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# ceph_gateway.sh FOLDER: runs a Ceph object gateway on free ports of 127.0.0.1, with a monitor and
# one storage daemon in memory. Prints the gateway's port once the gateway responds. Then executes
# commands from standard input (stop, kill, start) and replies to each with a line. Ends at the end
# of the input.
set -euo pipefail
cd "$1"
umask 077
folder=$PWD
export PATH=$PATH:/usr/sbin:/sbin CEPH_CONF=$folder/ceph.conf

# Prints two ports on which no program listens, below the range that outgoing connections use.
free_ports() {
  local lowest port
  read -r lowest _ </proc/sys/net/ipv4/ip_local_port_range
  for port in $(shuf -i "$((lowest - 8000))-$((lowest - 1))" -n 50); do
    (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null || echo "$port"
  done | head -n 2
}
{ read -r monitor_port; read -r gateway_port; } < <(free_ports)

cat >ceph.conf <<CONF
[global]
fsid = 11111111-2222-4333-8444-555555555555
mon_host = v2:127.0.0.1:$monitor_port
auth_allow_insecure_global_id_reclaim = false
keyring = $folder/keyring
admin_socket = $folder/\$name.asok
run_dir = $folder
log_file = $folder/\$name.log
mon_cluster_log_file = $folder/cluster.log
pid_file =
mon_allow_pool_size_one = true
mon_warn_on_pool_no_redundancy = false
mon_max_pg_per_osd = 1000
osd_pool_default_size = 1
osd_pool_default_min_size = 1
osd_pool_default_pg_num = 1
osd_pool_default_pgp_num = 1
osd_pool_default_pg_autoscale_mode = off
osd_crush_chooseleaf_type = 0
osd_objectstore = memstore
memstore_device_bytes = 1073741824
osd_data = $folder/osd
mon_data = $folder/mon
public_addr = 127.0.0.1
cluster_addr = 127.0.0.1
rgw_frontends = beast endpoint=127.0.0.1:$gateway_port
rgw_data = $folder
rgw_enable_usage_log = false
rgw_dns_name = localhost
CONF

children=()
stop() {
  kill "${children[@]}" 2>/dev/null || true
  sleep 0.2
  kill -9 "${children[@]}" 2>/dev/null || true
}
trap stop EXIT

# start NAME COMMAND…: runs the command in the background and writes its output to NAME.out.
start() {
  local name=$1
  shift
  "$@" </dev/null >"$name.out" 2>&1 &
  children+=($!)
}

ceph-authtool --create-keyring keyring --gen-key -n mon. --cap mon 'allow *' >keyring.out
for name in client.admin client.rgw osd.0; do
  ceph-authtool keyring --gen-key -n $name --cap mon 'allow *' --cap osd 'allow *' --cap mgr 'allow *' >>keyring.out
done
monmaptool --create --addv a "v2:127.0.0.1:$monitor_port" --fsid 11111111-2222-4333-8444-555555555555 monmap >/dev/null
mkdir mon osd
ceph-mon --mkfs -i a --monmap monmap --keyring keyring >mon-mkfs.out 2>&1
start mon ceph-mon -f -i a
identity=66666666-7777-4888-8999-aaaaaaaaaaaa
ceph osd new $identity 0 >/dev/null 2>&1
ceph-osd --mkfs -i 0 --osd-uuid $identity >osd-mkfs.out 2>&1
ceph osd crush add osd.0 1.0 root=default host=h >/dev/null 2>&1
start osd ceph-osd -f -i 0
radosgw-admin user create --uid museum --display-name museum --access-key museum \
  --secret-key the-secret-of-the-museum >user.out 2>&1
start_gateway() {
  start gateway radosgw -f -n client.rgw
  until (exec 3<>"/dev/tcp/127.0.0.1/$gateway_port") 2>/dev/null; do
    kill -0 "${children[@]}"
    sleep 0.1
  done
}
stop_gateway() {
  local gateway=${children[-1]}
  unset 'children[-1]'
  kill -9 "$gateway"
  wait "$gateway" 2>/dev/null || true
}
start_gateway
echo "$gateway_port"
while read -r command; do
  case $command in
    stop | kill) stop_gateway ;;
    start) start_gateway ;;
  esac
  echo "done"
done
