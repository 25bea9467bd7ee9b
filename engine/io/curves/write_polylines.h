// SPDX-License-Identifier: MIT
/// Writers of polylines, as a table or for ParaView.
///   .csv   line,s,x,y,z,tx,ty,tz: arc length, position and unit tangent, rows in ascending s; numbers read back exactly. Path lines and
///          streak lines have a further column "time"
///   .vtp   VTK's XML PolyData, raw appended doubles: one polyline per line. Points carry s, tangent, velocity and line (path lines and
///          streak lines: time instead of velocity); cells carry line, length, first_end and last_end (0 BOUNDARY, 1 CRITICAL, 2 LENGTH,
///          3 LAP, 4 INCOHERENT, 5 TIME)
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "engine/base/output_file.h"
#include "engine/field/field.h"
#include "engine/geometry/flow/curve.h"

namespace catena::curves {

/// First row of the table, with its line break.
inline constexpr const char* kPolylineTableHeader = "line,s,x,y,z,tx,ty,tz\n";
/// The same of path lines and streak lines.
inline constexpr const char* kTimedPolylineTableHeader = "line,s,x,y,z,tx,ty,tz,time\n";
/// Returns the first row of the table of these lines.
const char* polyline_table_header(const std::vector<flow::CurvePtr>& curves);
/// Appends the rows of one line to the text of a table. `line`: number of the line, its first column.
void append_polyline_rows(std::string& text, std::size_t line, const flow::Curve& curve);

/// Writes lines traced in `field`, world units.
void write_polylines_csv(OutputFile& out, const std::vector<flow::CurvePtr>& curves, const field::VectorField& field);
void write_polylines_vtp(OutputFile& out, const std::vector<flow::CurvePtr>& curves, const field::VectorField& field);

}  // namespace catena::curves
