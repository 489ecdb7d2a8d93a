// Runs one workload (workloads.py, write_for_peers) in SimGrid with its default network model, LV08.
//
//   simgrid_lv08 WORKLOAD      prints: CPU seconds of the run, simulated seconds
//
// The same placements and routes as ncsim, no radio. Tasks on one host share it, where ncsim runs them
// one after the other; the number of activities is the same.
#include <ctime>
#include <fstream>
#include <iostream>
#include <simgrid/s4u.hpp>
#include <string>
#include <vector>

namespace sg4 = simgrid::s4u;

int main(int argc, char** argv)
{
  sg4::Engine engine(&argc, argv);
  std::ifstream in(argv[1]);
  auto* zone = sg4::create_full_zone("grid");
  size_t count;

  in >> count;
  std::vector<sg4::Host*> hosts;
  for (size_t i = 0; i < count; i++) {
    double units_per_s;
    in >> units_per_s;
    hosts.push_back(zone->create_host("n" + std::to_string(i), units_per_s)->seal());
  }
  in >> count;
  std::vector<sg4::Link*> links;
  for (size_t i = 0; i < count; i++) {
    double MBps;
    in >> MBps;
    auto* link = zone->create_link("l" + std::to_string(i), MBps * 1e6)->set_latency(0);
    link->set_concurrency_limit(-1);
    links.push_back(link->seal());
  }
  in >> count;
  for (size_t i = 0; i < count; i++) {
    size_t source, target, hops, link;
    in >> source >> target >> hops;
    std::vector<sg4::LinkInRoute> route;
    for (size_t hop = 0; hop < hops; hop++) {
      in >> link;
      route.emplace_back(links[link]);
    }
    zone->add_route(hosts[source]->get_netpoint(), hosts[target]->get_netpoint(), nullptr, nullptr, route, false);
  }
  zone->seal();

  in >> count;
  std::vector<sg4::ExecPtr> tasks;
  for (size_t i = 0; i < count; i++) {
    double units;
    size_t host;
    in >> units >> host;
    auto task = sg4::Exec::init();
    task->set_name("T" + std::to_string(i));
    task->set_flops_amount(units)->set_host(hosts[host]);
    tasks.push_back(task);
  }
  in >> count;
  std::vector<sg4::CommPtr> transfers;
  for (size_t i = 0; i < count; i++) {
    size_t source, target;
    double MB;
    in >> source >> target >> MB;
    auto *from = tasks[source]->get_host(), *to = tasks[target]->get_host();
    if (from == to) {
      tasks[source]->add_successor(tasks[target]);
      continue;
    }
    auto transfer = sg4::Comm::sendto_init(from, to);
    transfer->set_name("x" + std::to_string(i));
    transfer->set_payload_size(MB * 1e6);
    tasks[source]->add_successor(transfer);
    transfer->add_successor(tasks[target]);
    transfers.push_back(transfer);
  }
  for (auto& task : tasks)
    task->vetoable_start();
  for (auto& transfer : transfers)
    transfer->vetoable_start();

  std::clock_t started = std::clock();
  engine.run();
  std::cout << static_cast<double>(std::clock() - started) / CLOCKS_PER_SEC << " s, "
            << sg4::Engine::get_clock() << " s simulated" << std::endl;
  return 0;
}
