// Puts a cell on a list of work (shared/tasks.wgsl), with its place among all that are listed.
fn list_cell(cell: u32, list: u32) {
    let place = atomicAdd(&work[LISTED], 1u);
    sampled[cell] = place + 2u;
    tasks[place_in_list(list, atomicAdd(&work[list], 1u), arrayLength(&tasks))] = vec2(cell, place);
}
