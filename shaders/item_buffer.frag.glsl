flat in uint v_item;

out uint item_out;

void main() { item_out = v_item; }
