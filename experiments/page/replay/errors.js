// The error in space: every contact coloured by how wrong an answer is there.

function addErrorPoints() {}
