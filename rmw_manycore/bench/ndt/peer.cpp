// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// PCL's NDT, or one with the same interface, as a peer of `manycore bench ndt`; compiled by the
// bench.
//
//   peer WORLD RESOLUTION [THREADS]     reads commands from standard input, prints a line for each:
//   evaluate I       -> ns score        derivatives of scan I at its pose
//   align I          -> ns iterations T_map_sensor (16 numbers, row by row)
//
// WORLD: number and points of the map (u64, f32 x 3 each), number of scans; then for each scan its
// pose and guess (f64 x 16 each, row-major), number and points.

#include <pcl/common/transforms.h>
#include <pcl/point_types.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#ifdef PEER_PCLOMP
#include <pclomp/ndt_omp.h>
#include <pclomp/ndt_omp_impl.hpp>
#include <pclomp/voxel_grid_covariance_omp_impl.hpp>
namespace peer = pclomp;
#else
#include <pcl/registration/ndt.h>
namespace peer = pcl;
#endif

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Base = peer::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ>;

/// Exposes computeDerivatives(), which is protected: no public function measures a single pass.
struct Ndt : Base {
  double evaluate(Cloud & moved, const Eigen::Matrix4f & pose) {
    const Eigen::Affine3f transform(pose);
    Eigen::Matrix<double, 6, 1> at;
    at.head<3>() = transform.translation().cast<double>();
    at.tail<3>() = transform.rotation().eulerAngles(0, 1, 2).cast<double>();
    Eigen::Matrix<double, 6, 1> gradient;
    Eigen::Matrix<double, 6, 6> hessian;
    return computeDerivatives(gradient, hessian, moved, at);
  }
};

struct Scan {
  Eigen::Matrix4f pose;
  Eigen::Matrix4f guess;
  Cloud::Ptr points;
};

template<typename T>
T read(std::istream & in) {
  T value;
  in.read(reinterpret_cast<char *>(&value), sizeof value);
  return value;
}

Cloud::Ptr read_points(std::istream & in) {
  const auto count = read<uint64_t>(in);
  auto cloud = Cloud::Ptr(new Cloud);
  for (uint64_t i = 0; i < count; ++i) {
    const auto x = read<float>(in);
    const auto y = read<float>(in);
    cloud->emplace_back(x, y, read<float>(in));
  }
  return cloud;
}

Eigen::Matrix4f read_pose(std::istream & in) {
  Eigen::Matrix4f pose;
  for (int i = 0; i < 16; ++i) {
    pose(i / 4, i % 4) = static_cast<float>(read<double>(in));
  }
  return pose;
}

double since_ns(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
}

void evaluate(Ndt & ndt, const Scan & scan) {
  ndt.setInputSource(scan.points);
  const auto start = std::chrono::steady_clock::now();
  Cloud moved;
  pcl::transformPointCloud(*scan.points, moved, scan.pose);
  const double score = ndt.evaluate(moved, scan.pose);
  std::cout << since_ns(start) << ' ' << score << std::endl;
}

void align(Ndt & ndt, const Scan & scan) {
  ndt.setInputSource(scan.points);
  const auto start = std::chrono::steady_clock::now();
  Cloud moved;
  ndt.align(moved, scan.guess);
  const double ns = since_ns(start);
  const Eigen::Matrix4f found = ndt.getFinalTransformation();
  std::cout << ns << ' ' << ndt.getFinalNumIteration();
  for (int i = 0; i < 16; ++i) {
    std::cout << ' ' << found(i / 4, i % 4);
  }
  std::cout << std::endl;
}

}  // namespace

int main(int argc, char ** argv) {
  if (argc < 3) {
    std::cerr << "usage: peer WORLD RESOLUTION [THREADS]\n";
    return 2;
  }
  std::ifstream in(argv[1], std::ios::binary);
  const Cloud::Ptr map = read_points(in);
  std::vector<Scan> scans(read<uint64_t>(in));
  for (Scan & scan : scans) {
    scan.pose = read_pose(in);
    scan.guess = read_pose(in);
    scan.points = read_points(in);
  }

  Ndt ndt;
  ndt.setResolution(std::strtof(argv[2], nullptr));
  ndt.setStepSize(0.1);
  ndt.setTransformationEpsilon(0.01);
#ifdef PEER_PCLOMP
  ndt.setNumThreads(argc > 3 ? std::atoi(argv[3]) : 1);
  ndt.setNeighborhoodSearchMethod(pclomp::DIRECT7);
#endif
  ndt.setInputTarget(map);
  // The constants of the score are set only by an alignment.
  ndt.setMaximumIterations(1);
  Cloud moved;
  ndt.setInputSource(scans.front().points);
  ndt.align(moved, scans.front().pose);
  ndt.setMaximumIterations(30);
  std::cout.precision(12);
  std::cout << "ready" << std::endl;

  std::string command;
  for (size_t scan = 0; std::cin >> command >> scan;) {
    command == "align" ? align(ndt, scans.at(scan)) : evaluate(ndt, scans.at(scan));
  }
  return 0;
}
