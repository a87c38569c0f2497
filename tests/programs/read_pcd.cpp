// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Reads PCD files with PCL, for tests/support/comparisons/pcl_results.py: a path per line of
// standard input, a line of standard output for each, "refused" or x, y and z of each point. Not
// part of the build:
//
//   apt install libpcl-dev
//   g++ -std=c++14 $(pkg-config --cflags --libs pcl_io) tests/programs/read_pcd.cpp -o read_pcd

#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <string>

namespace {

template<typename Number>
double number_at(const uint8_t * place) {
  Number number;
  std::memcpy(&number, place, sizeof number);
  return static_cast<double>(number);
}

double value_of(const pcl::PCLPointCloud2 & cloud, const pcl::PCLPointField & field, size_t point) {
  const uint8_t * place = &cloud.data[point * cloud.point_step + field.offset];
  switch (field.datatype) {
    case pcl::PCLPointField::INT8:
      return number_at<int8_t>(place);
    case pcl::PCLPointField::UINT8:
      return number_at<uint8_t>(place);
    case pcl::PCLPointField::INT16:
      return number_at<int16_t>(place);
    case pcl::PCLPointField::UINT16:
      return number_at<uint16_t>(place);
    case pcl::PCLPointField::INT32:
      return number_at<int32_t>(place);
    case pcl::PCLPointField::UINT32:
      return number_at<uint32_t>(place);
    case pcl::PCLPointField::FLOAT32:
      return number_at<float>(place);
    case pcl::PCLPointField::FLOAT64:
      return number_at<double>(place);
    default:
      return std::nan("");
  }
}

void print_points(const std::string & path) {
  pcl::PCLPointCloud2 cloud;
  Eigen::Vector4f origin;
  Eigen::Quaternionf orientation;
  int version = 0;
  pcl::PCDReader reader;
  std::array<const pcl::PCLPointField *, 3> axes = {};
  if (reader.read(path, cloud, origin, orientation, version) >= 0) {
    for (const auto & field : cloud.fields) {
      for (size_t axis = 0; axis < axes.size(); ++axis) {
        if (field.name == std::string(1, static_cast<char>('x' + axis))) {
          axes[axis] = &field;
        }
      }
    }
  }
  if (axes[0] == nullptr || axes[1] == nullptr || axes[2] == nullptr) {
    std::printf("refused\n");
    return;
  }
  for (size_t point = 0; point < size_t{cloud.width} * cloud.height; ++point) {
    for (const auto * axis : axes) {
      std::printf("%a ", value_of(cloud, *axis, point));
    }
  }
  std::printf("\n");
}

}  // namespace

int main() {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  for (std::string path; std::getline(std::cin, path);) {
    print_points(path);
    std::fflush(stdout);  // damaged files end the process
  }
}
