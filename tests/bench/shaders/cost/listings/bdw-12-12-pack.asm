pln(16)         g12<1>F         g6<0,1,0>F      g2<8,8,1>F      { align1 1H compacted };
pln(16)         g14<1>F         g6.4<0,1,0>F    g2<8,8,1>F      { align1 1H compacted };
pln(16)         g119<1>F        g8<0,1,0>F      g2<8,8,1>F      { align1 1H compacted };
pln(16)         g121<1>F        g8.4<0,1,0>F    g2<8,8,1>F      { align1 1H compacted };
pln(16)         g123<1>F        g9<0,1,0>F      g2<8,8,1>F      { align1 1H compacted };
mov(1)          g70<1>D         1056964608D                     { align1 WE_all 1N };
mov(16)         g20<1>UD        g0<8,8,1>UD                     { align1 WE_all 1H compacted };
mad.sat(16)     g30<1>F         g70.0<0,1,0>F   g70.0<0,1,0>F   g12<4,4,1>F { align16 1H };
mad.sat(16)     g41<1>F         g70.0<0,1,0>F   g70.0<0,1,0>F   g14<4,4,1>F { align16 1H };
mul(16)         g32<1>F         g30<8,8,1>F     0x457ff000F  /* 4095F */ { align1 1H };
mul(16)         g43<1>F         g41<8,8,1>F     0x457ff000F  /* 4095F */ { align1 1H };
rnde(16)        g34<1>F         g32<8,8,1>F                     { align1 1H compacted };
rnde(16)        g45<1>F         g43<8,8,1>F                     { align1 1H compacted };
mov(16)         g36<1>D         g34<8,8,1>F                     { align1 1H compacted };
mov(16)         g47<1>D         g45<8,8,1>F                     { align1 1H compacted };
shr(16)         g38<1>UD        g36<8,8,1>UD    0x00000004UD    { align1 1H compacted };
shl(16)         g40<1>D         g36<8,8,1>D     0x00000004UD    { align1 1H };
shr(16)         g49<1>UD        g47<8,8,1>UD    0x00000008UD    { align1 1H compacted };
mov(16)         g55<1>F         g47<32,8,4>UB                   { align1 1H };
mov(16)         g53<1>F         g38<32,8,4>UB                   { align1 1H };
or(16)          g51<1>UD        g40<8,8,1>UD    g49<8,8,1>UD    { align1 1H compacted };
mul(16)         g26<1>F         g55<8,8,1>F     0x3b808081F  /* 0.00392157F */ { align1 1H };
mul(16)         g22<1>F         g53<8,8,1>F     0x3b808081F  /* 0.00392157F */ { align1 1H };
mov(16)         g54<1>F         g51<32,8,4>UB                   { align1 1H };
mul(16)         g24<1>F         g54<8,8,1>F     0x3b808081F  /* 0.00392157F */ { align1 1H };
sendc(16)       null<1>UW       g20<8,8,1>UD    0x140b0000
                            render MsgDesc: RT write SIMD16 Surface = 0 mlen 10 rlen 0 { align1 1H };
mov(16)         g10<1>UD        g0<8,8,1>UD                     { align1 WE_all 1H compacted };
mov(1)          g10.2<1>UD      0x00000001UD                    { align1 WE_all 1N compacted };
sendc(16)       null<1>UW       g10<8,8,1>UD    0x140b0001
                            render MsgDesc: RT write SIMD16 Surface = 1 mlen 10 rlen 0 { align1 1H };
mov(16)         g117<1>UD       g0<8,8,1>UD                     { align1 WE_all 1H compacted };
mov(1)          g117.2<1>UD     0x00000002UD                    { align1 WE_all 1N compacted };
sendc(16)       null<1>UW       g117<8,8,1>UD   0x940b1002
                            render MsgDesc: RT write SIMD16 LastRT Surface = 2 mlen 10 rlen 0 { align1 1H EOT };
