// SPDX-License-Identifier: CC0-1.0
// A vase: a polygon turned full circle.
rotate_extrude($fn = 60) polygon([
    [0, 0], [15, 0], [20, 12], [22, 25], [18, 40], [10, 52], [9, 58], [12, 66],
    [10, 66], [7, 58], [8, 51], [16, 39], [20, 25], [18, 13], [14, 3], [0, 3]
]);
