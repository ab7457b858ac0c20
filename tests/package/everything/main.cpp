// Holds every object of every component: nothing may be left undefined.
int main() { return 0; }
