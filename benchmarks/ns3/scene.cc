// Saturated goodput of 802.11ax links, and of relayed transfers, in ns-3.44.
//
// Makes cases like those of ncsim_wifi/validation/packet_data, whose SOURCE.md states the settings.
// With the PyPI wheel ns3==3.44.post0 under $NS3 (the folder that holds include/ and lib64/):
//
//   g++ -std=c++20 -O2 -I$NS3/include scene.cc -o scene -L$NS3/lib64 -Wl,-rpath,$NS3/lib64 \
//     -Wl,--allow-shlib-undefined $(for m in core network mobility internet wifi propagation; \
//     do echo -lns3.44-$m; done)
//
// Input, numbers apart by white space: RTS/CTS (0 or 1), seed, seconds; number of nodes, their x and
// y in metres; number of transfers, for each its MCS, the number of its nodes, and these nodes.
// Output, a line per transfer: MB/s of payload. With a file's name as argument it also gets a line
// per frame sent, T, its start and duration in us, sender, kind and receiver; per frame lost at its
// receiver, D, the time in us, receiver, sender and why; per data frame acknowledged, A, the time,
// sender and receiver.
//
// A transfer of one hop keeps 30 packets queued at its sender, a relayed one 16 in the network. All
// transfers that pass a node must have one MCS.

#include "ns3/core-module.h"
#include "ns3/internet-module.h"
#include "ns3/mobility-module.h"
#include "ns3/network-module.h"
#include "ns3/wifi-mac-header.h"
#include "ns3/wifi-mac.h"
#include "ns3/wifi-mpdu.h"
#include "ns3/wifi-net-device.h"
#include "ns3/wifi-phy.h"
#include "ns3/wifi-ppdu.h"
#include "ns3/wifi-psdu.h"
#include "ns3/yans-wifi-helper.h"

#include <fstream>
#include <iostream>
#include <map>
#include <string>
#include <vector>

using namespace ns3;

constexpr int FIRST_PORT = 9000;
constexpr int PAYLOAD_bytes = 1472;
constexpr double START_s = 0.3; // of the measurement; traffic starts at 0.1 s

struct Transfer {
    int mcs = 0;
    std::vector<int> path;
    Ptr<Socket> socket;
    InetSocketAddress target{Ipv4Address::GetAny(), 0};
    uint64_t received_bytes = 0;

    bool IsRelayed() const { return path.size() > 2; }
};

std::vector<Transfer> transfers;

void SendOne(int number) {
    auto& transfer = transfers[number];
    transfer.socket->SendTo(Create<Packet>(PAYLOAD_bytes), 0, transfer.target);
}

void Received(int number, Ptr<Socket> socket) {
    while (auto packet = socket->Recv()) {
        if (transfers[number].IsRelayed()) {
            Simulator::ScheduleNow(&SendOne, number);
        }
        if (Simulator::Now().GetSeconds() > START_s) {
            transfers[number].received_bytes += packet->GetSize();
        }
    }
}

// Replace a packet that its first sender has got rid of.
void Done(int node, Ptr<const WifiMpdu> mpdu) {
    if (!mpdu->GetHeader().IsQosData()) {
        return;
    }
    auto packet = mpdu->GetPacket()->Copy();
    LlcSnapHeader llc;
    packet->RemoveHeader(llc);
    if (llc.GetType() != Ipv4L3Protocol::PROT_NUMBER) {
        return;
    }
    Ipv4Header ip;
    packet->RemoveHeader(ip);
    UdpHeader udp;
    packet->RemoveHeader(udp);
    int number = udp.GetDestinationPort() - FIRST_PORT;
    if (!transfers[number].IsRelayed() && transfers[number].path.front() == node) {
        Simulator::ScheduleNow(&SendOne, number);
    }
}

std::ofstream frames;
std::map<Mac48Address, int> node_of;

double Now_us() { return Simulator::Now().GetNanoSeconds() / 1000.0; }

std::string KindOf(const WifiMacHeader& header) {
    return header.IsQosData() ? "data"
           : header.IsAck()   ? "ack"
           : header.IsRts()   ? "rts"
           : header.IsCts()   ? "cts"
                              : "other";
}

void Sent(int node, WifiConstPsduMap psdus, WifiTxVector vector, double) {
    auto psdu = psdus.begin()->second;
    auto& header = psdu->GetHeader(0);
    auto lasts = WifiPhy::CalculateTxDuration(psdu->GetSize(), vector, WIFI_PHY_BAND_5GHZ);
    frames << "T " << Now_us() << ' ' << lasts.GetNanoSeconds() / 1000.0 << ' ' << node << ' '
           << KindOf(header) << ' ' << node_of[header.GetAddr1()] << '\n';
}

void Lost(int node, Ptr<const WifiPpdu> ppdu, WifiPhyRxfailureReason reason) {
    auto& header = ppdu->GetPsdu()->GetHeader(0);
    if (header.IsAck() || header.IsCts() || node_of[header.GetAddr1()] != node) {
        return;
    }
    frames << "D " << Now_us() << ' ' << node << ' ' << node_of[header.GetAddr2()] << ' ' << reason
           << '\n';
}

void Acknowledged(int node, Ptr<const WifiMpdu> mpdu) {
    frames << "A " << Now_us() << ' ' << node << ' ' << node_of[mpdu->GetHeader().GetAddr1()]
           << '\n';
}

void LogFrames(const std::string& file, NetDeviceContainer& devices) {
    frames.open(file);
    frames.precision(12);
    for (uint32_t node = 0; node < devices.GetN(); node++) {
        auto device = DynamicCast<WifiNetDevice>(devices.Get(node));
        node_of[device->GetMac()->GetAddress()] = node;
        device->GetPhy()->TraceConnectWithoutContext(
            "PhyTxPsduBegin",
            Callback<void, WifiConstPsduMap, WifiTxVector, double>(
                [node](WifiConstPsduMap psdus, WifiTxVector vector, double power_W) {
                    Sent(node, psdus, vector, power_W);
                }));
        device->GetPhy()->TraceConnectWithoutContext(
            "PhyRxPpduDrop", Callback<void, Ptr<const WifiPpdu>, WifiPhyRxfailureReason>(
                                 [node](Ptr<const WifiPpdu> ppdu, WifiPhyRxfailureReason reason) {
                                     Lost(node, ppdu, reason);
                                 }));
        device->GetMac()->TraceConnectWithoutContext(
            "AckedMpdu", Callback<void, Ptr<const WifiMpdu>>(
                             [node](Ptr<const WifiMpdu> mpdu) { Acknowledged(node, mpdu); }));
    }
}

NetDeviceContainer MakeRadios(NodeContainer& nodes, const std::vector<int>& mcs, bool rts_cts) {
    Config::SetDefault("ns3::WifiMac::FrameRetryLimit", UintegerValue(6));
    Config::SetDefault("ns3::WifiMacQueue::MaxDelay", TimeValue(Seconds(10)));
    Config::SetDefault("ns3::WifiRemoteStationManager::RtsCtsThreshold",
                       UintegerValue(rts_cts ? 0 : 4692480));
    YansWifiChannelHelper channel;
    channel.SetPropagationDelay("ns3::ConstantSpeedPropagationDelayModel");
    channel.AddPropagationLoss("ns3::LogDistancePropagationLossModel", "Exponent", DoubleValue(3.0),
                               "ReferenceLoss", DoubleValue(46.4));
    YansWifiPhyHelper phy;
    phy.SetChannel(channel.Create());
    phy.Set("ChannelSettings", StringValue("{36, 20, BAND_5GHZ, 0}"));
    phy.Set("TxPowerStart", DoubleValue(20));
    phy.Set("TxPowerEnd", DoubleValue(20));
    phy.Set("RxNoiseFigure", DoubleValue(6));
    phy.Set("CcaEdThreshold", DoubleValue(-82));
    WifiHelper wifi;
    wifi.SetStandard(WIFI_STANDARD_80211ax);
    wifi.ConfigHeOptions("GuardInterval", TimeValue(NanoSeconds(800)));
    NetDeviceContainer devices;
    for (uint32_t node = 0; node < nodes.GetN(); node++) {
        WifiMacHelper mac;
        mac.SetType("ns3::AdhocWifiMac", "BE_MaxAmpduSize", UintegerValue(0), "BE_MaxAmsduSize",
                    UintegerValue(0));
        wifi.SetRemoteStationManager("ns3::ConstantRateWifiManager", "DataMode",
                                     StringValue("HeMcs" + std::to_string(mcs[node])),
                                     "ControlMode", StringValue("OfdmRate24Mbps"));
        devices.Add(wifi.Install(phy, mac, nodes.Get(node)));
    }
    WifiHelper::AssignStreams(devices, 100);
    return devices;
}

// Everybody knows everybody's address, so that no ARP is sent.
Ipv4InterfaceContainer MakeAddresses(NodeContainer& nodes, NetDeviceContainer& devices) {
    InternetStackHelper stack;
    stack.SetIpv6StackInstall(false);
    stack.Install(nodes);
    Ipv4AddressHelper addresses;
    addresses.SetBase("10.0.0.0", "255.255.255.0");
    auto interfaces = addresses.Assign(devices);
    for (uint32_t node = 0; node < nodes.GetN(); node++) {
        auto cache = nodes.Get(node)->GetObject<Ipv4L3Protocol>()->GetInterface(1)->GetArpCache();
        for (uint32_t other = 0; other < nodes.GetN(); other++) {
            if (other != node) {
                auto entry = cache->Add(interfaces.GetAddress(other));
                entry->SetMacAddress(devices.Get(other)->GetAddress());
                entry->MarkPermanent();
            }
        }
    }
    return interfaces;
}

void Start(int number, NodeContainer& nodes, Ipv4InterfaceContainer& interfaces, double offset_s) {
    auto& transfer = transfers[number];
    int last = transfer.path.back();
    Ipv4StaticRoutingHelper routing;
    for (size_t hop = 0; hop + 2 < transfer.path.size(); hop++) {
        auto ipv4 = nodes.Get(transfer.path[hop])->GetObject<Ipv4>();
        routing.GetStaticRouting(ipv4)->AddHostRouteTo(
            interfaces.GetAddress(last), interfaces.GetAddress(transfer.path[hop + 1]), 1);
    }
    auto sink = Socket::CreateSocket(nodes.Get(last), UdpSocketFactory::GetTypeId());
    sink->Bind(InetSocketAddress(Ipv4Address::GetAny(), FIRST_PORT + number));
    sink->SetRecvCallback(Callback<void, Ptr<Socket>>(
        [number](Ptr<Socket> socket) { Received(number, socket); }));
    transfer.socket =
        Socket::CreateSocket(nodes.Get(transfer.path.front()), UdpSocketFactory::GetTypeId());
    transfer.socket->Bind();
    transfer.target = InetSocketAddress(interfaces.GetAddress(last), FIRST_PORT + number);
    for (int packet = 0; packet < (transfer.IsRelayed() ? 16 : 30); packet++) {
        Simulator::Schedule(Seconds(0.1 + offset_s + packet * 1e-5), &SendOne, number);
    }
}

int main(int argument_count, char** arguments) {
    int rts_cts, seed, node_count, transfer_count;
    double duration_s;
    std::cin >> rts_cts >> seed >> duration_s >> node_count;
    auto places = CreateObject<ListPositionAllocator>();
    for (int node = 0; node < node_count; node++) {
        double x, y;
        std::cin >> x >> y;
        places->Add(Vector(x, y, 0.0));
    }
    std::cin >> transfer_count;
    transfers.resize(transfer_count);
    std::vector<int> mcs(node_count, 5);
    for (auto& transfer : transfers) {
        int length;
        std::cin >> transfer.mcs >> length;
        transfer.path.resize(length);
        for (auto& node : transfer.path) {
            std::cin >> node;
        }
        for (int hop = 0; hop + 1 < length; hop++) {
            mcs[transfer.path[hop]] = transfer.mcs;
        }
    }
    RngSeedManager::SetSeed(1);
    RngSeedManager::SetRun(seed);
    NodeContainer nodes;
    nodes.Create(node_count);
    MobilityHelper mobility;
    mobility.SetPositionAllocator(places);
    mobility.SetMobilityModel("ns3::ConstantPositionMobilityModel");
    mobility.Install(nodes);
    auto devices = MakeRadios(nodes, mcs, rts_cts);
    auto interfaces = MakeAddresses(nodes, devices);
    for (int node = 0; node < node_count; node++) {
        auto mac = DynamicCast<WifiNetDevice>(devices.Get(node))->GetMac();
        mac->TraceConnectWithoutContext(
            "AckedMpdu", Callback<void, Ptr<const WifiMpdu>>(
                             [node](Ptr<const WifiMpdu> mpdu) { Done(node, mpdu); }));
        mac->TraceConnectWithoutContext(
            "DroppedMpdu",
            Callback<void, WifiMacDropReason, Ptr<const WifiMpdu>>(
                [node](WifiMacDropReason, Ptr<const WifiMpdu> mpdu) { Done(node, mpdu); }));
    }
    if (argument_count > 1) {
        LogFrames(arguments[1], devices);
    }
    auto offsets = CreateObject<UniformRandomVariable>();
    for (int number = 0; number < transfer_count; number++) {
        Start(number, nodes, interfaces, offsets->GetValue(0, 0.005));
    }
    Simulator::Stop(Seconds(START_s + duration_s));
    Simulator::Run();
    for (const auto& transfer : transfers) {
        std::cout << transfer.received_bytes / duration_s / 1e6 << "\n";
    }
    Simulator::Destroy();
}
