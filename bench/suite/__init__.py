"""Many tables in one run, and the page that shows them."""
